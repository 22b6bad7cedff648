// bounds/aabb_volume.h - the axis-aligned box: the volume that all others are compared with.
//
// Layout:     six floats rounded outward, 24 bytes.
// Margins:    those of clip_to_box() (math/margin.h); the slack of bound_margin.h is not needed,
//             as axis planes have relative errors only and hits on curves are tied to their boxes.
// Measure:    exact of the stored box. merge() is exact.
// Thread safety: values.
#pragma once

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/polytope.h>
#include <strahl/math/float_round.h>

namespace strahl {

struct AabbRay {
  const PreparedRay* ray = nullptr;
  AabbRay() = default;
  AabbRay(const PreparedRay& prepared, const Aabb&) : ray(&prepared) {}
};

class AabbVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::aabb;
  using RayData = AabbRay;

  AabbVolume() = default;
  explicit AabbVolume(const Aabb& box)
      : lo_(float_below(box.lo.x), float_below(box.lo.y), float_below(box.lo.z)),
        hi_(float_above(box.hi.x), float_above(box.hi.y), float_above(box.hi.z)) {}
  static AabbVolume enclose(const EnclosedSet& set, FitEffort = FitEffort::fast) {
    if (set.is_unbounded()) return AabbVolume({Vec3d::all(-Aabb::kInf), Vec3d::all(Aabb::kInf)});
    return AabbVolume(set.box());
  }
  static AabbVolume merge(const AabbVolume& a, const AabbVolume& b) {
    AabbVolume both;
    both.lo_ = min(a.lo_, b.lo_), both.hi_ = max(a.hi_, b.hi_);
    return both;
  }

  Aabb box() const { return {Vec3d(lo_), Vec3d(hi_)}; }
  Interval clip(const AabbRay& ray, Interval in) const {
    return clip_to_box(*ray.ray, Vec3d(lo_), Vec3d(hi_), in);
  }
  double half_area() const { return box().half_area(); }
  double volume() const {
    const Vec3d e = box().extent();
    return box().is_empty() ? 0.0 : e.x * e.y * e.z;
  }
  bool contains(const Vec3d& p) const { return box().contains(p); }
  std::size_t bytes() const { return sizeof(*this); }
  void add_corners_to(EnclosedSet& set) const { set.add(box()); }
  void add_sides_to(SideList& sides) const { sides.add(box()); }
  void add_planes_to(Polytope&) const {}  // a polytope is made within box()

 private:
  Vec3f lo_ = Vec3f::all(std::numeric_limits<float>::infinity());
  Vec3f hi_ = Vec3f::all(-std::numeric_limits<float>::infinity());
};
static_assert(sizeof(AabbVolume) == 24 && PolyhedralVolume<AabbVolume>);

}  // namespace strahl
