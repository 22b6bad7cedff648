// structures/wide_bvh/wide_frame.h - the coordinates in which a wide tree holds its floats.
//
// A position p of the scene is (p - center) * scale, scale a power of two. Scenes whose size and
//   place suit float arithmetic keep their own coordinates (center 0, scale 1): floats are not
//   rounded then. Others are moved to the origin and scaled to about 1, so that the kernels never
//   meet magnitudes whose products leave the range of floats, and far scenes keep their detail.
// Invariant: |coordinate| <= reach for every plane of a non-empty box, 0 < reach <= 2^21.
#pragma once

#include <strahl/math/aabb.h>

namespace strahl {

struct WideFrame {
  Vec3d center;
  double scale = 1.0;
  double reach = 1.0;

  bool is_identity() const { return scale == 1.0 && center == Vec3d{}; }
  /// Rounded: each component to within 2^-53 of its magnitude.
  Vec3d to_frame(const Vec3d& p) const { return (p - center) * scale; }
  /// At most so much of a plane within reach is lost by to_frame().
  double rounding() const { return is_identity() ? 0.0 : 0x1p-50 * reach; }
};

/// A frame for things within `box`, which may be empty.
WideFrame make_wide_frame(const Aabb& box);

}  // namespace strahl
