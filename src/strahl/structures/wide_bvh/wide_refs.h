// structures/wide_bvh/wide_refs.h - the things of a source as boxes of floats in a wide tree's
// frame.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/float_cut.h>
#include <strahl/build/float_ref.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_frame.h>

namespace strahl {

struct WideRefs {
  std::unique_ptr<FloatRef[]> room;
  std::size_t count = 0, spare = 0;
  WideFrame frame;
  bool all_floats = false;  ///< all triangles have corners of floats

  std::span<FloatRef> refs() { return {room.get(), count}; }
  /// The same and the free places behind them.
  std::span<FloatRef> with_spare() { return {room.get(), count + spare}; }
};

/// One per thing that can be hit, ascending; boxes rounded outward into a frame that suits them
/// all. O(n). The same for any executor. Throws Error{resource}, Error{cancelled}.
/// @param growth free places behind them, per reference
WideRefs make_wide_refs(const PrimitiveSource& source, const BuildContext& context,
                        double growth = 0.0);

/// Triangles in a frame, for cutting them.
class WideThings final : public FloatThings {
 public:
  /// The source must outlive it.
  WideThings(const PrimitiveSource& source, const WideFrame& frame)
      : source_(source), frame_(frame) {}
  bool corners(std::uint32_t reference, std::array<Vec3d, 3>& out) const override {
    TriangleVertices triangle;
    if (!source_.triangle(reference, triangle)) return false;
    out = {frame_.to_frame(triangle.a), frame_.to_frame(triangle.b), frame_.to_frame(triangle.c)};
    return true;
  }
  double rounding() const override { return frame_.rounding(); }
  double reach() const override { return frame_.reach; }

 private:
  const PrimitiveSource& source_;
  WideFrame frame_;
};

}  // namespace strahl
