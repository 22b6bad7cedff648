// bounds/intersection_volume.h - several volumes at once: the ray has to meet all of them.
//
// Paper:      [Weghorst1984] for the cost: of two, B = B_a + P_a B_b, so the order matters; the one
// with
//             the least B / (1 - P) comes first.
// Layout:     the volumes one after the other. `intersection` in a SPEC is aabb and obb, 84 bytes:
// flat
//             and slanted parts get the box that suits them, and the cheap test often ends it.
// Margins:    those of the volumes.
// Measure:    where all are polyhedra that of the polytope they have in common, else the least of
//             theirs, an upper bound. merge(): of each kind by itself.
// Thread safety: values.
#pragma once

#include <algorithm>
#include <tuple>
#include <utility>

#include <strahl/bounds/aabb_volume.h>
#include <strahl/bounds/obb_volume.h>

namespace strahl {

template <BoundingVolume... V>
class Intersection {
  static_assert(sizeof...(V) >= 1);
  static constexpr bool kIsPolyhedral = (PolyhedralVolume<V> && ...);

 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::intersection;
  struct RayData {
    std::tuple<typename V::RayData...> part;
    RayData() = default;
    RayData(const PreparedRay& ray, const Aabb& world) : part(typename V::RayData(ray, world)...) {}
  };

  Intersection() = default;
  explicit Intersection(const V&... part) : part_(part...) {}
  static Intersection enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough) {
    return Intersection(V::enclose(set, effort)...);
  }
  static Intersection merge(const Intersection& a, const Intersection& b) {
    return Intersection(V::merge(std::get<V>(a.part_), std::get<V>(b.part_))...);
  }

  Interval clip(const RayData& ray, Interval in) const {
    clip_each(ray, in, std::index_sequence_for<V...>());
    return in;
  }
  double half_area() const {
    if constexpr (kIsPolyhedral) return measure().half_area;
    return std::min({std::get<V>(part_).half_area()...});
  }
  double volume() const {
    if constexpr (kIsPolyhedral) return measure().volume;
    return std::min({std::get<V>(part_).volume()...});
  }
  bool contains(const Vec3d& p) const { return (std::get<V>(part_).contains(p) && ...); }
  std::size_t bytes() const { return sizeof(*this) + (owned(std::get<V>(part_)) + ...); }
  /// The corners of what all have in common, else of the first.
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const { (std::get<V>(part_).add_sides_to(sides), ...); }
  template <class W>
  const W& part() const {
    return std::get<W>(part_);
  }

 private:
  /// One after the other, until nothing is left.
  template <std::size_t... I>
  void clip_each(const RayData& ray, Interval& in, std::index_sequence<I...>) const {
    const auto clip_one = [&](const auto& volume, const auto& ray_part) {
      in = volume.clip(ray_part, in);
      return in.t_enter > in.t_exit;
    };
    static_cast<void>((clip_one(std::get<I>(part_), std::get<I>(ray.part)) || ...));
  }
  template <class W>
  static std::size_t owned(const W& volume) {
    return volume.bytes() - sizeof(W);
  }
  Aabb common_box() const;
  Polytope::Measure measure() const;
  Polytope common_body(const Aabb& box, Polytope::Use use) const;
  std::tuple<V...> part_;
};

template <BoundingVolume... V>
Aabb Intersection<V...>::common_box() const {
  Aabb common{Vec3d::all(-Aabb::kInf), Vec3d::all(Aabb::kInf)};
  ((common = Aabb::intersection(common, std::get<V>(part_).box())), ...);
  return common;
}

template <BoundingVolume... V>
Polytope Intersection<V...>::common_body(const Aabb& box, Polytope::Use use) const {
  Polytope body(box, use);
  (std::get<V>(part_).add_planes_to(body), ...);
  return body;
}

template <BoundingVolume... V>
Polytope::Measure Intersection<V...>::measure() const {
  const Aabb box = common_box();
  return box.is_empty() ? Polytope::Measure{} : common_body(box, Polytope::Use::measure).measure();
}

template <BoundingVolume... V>
void Intersection<V...>::add_corners_to(EnclosedSet& set) const {
  if constexpr (kIsPolyhedral) {
    const Aabb box = common_box();
    if (box.is_empty()) return;
    if (!is_finite(box.lo) || !is_finite(box.hi)) return set.add(box);
    common_body(box, Polytope::Use::corners).add_corners_to(set);
  } else {
    std::get<0>(part_).add_corners_to(set);
  }
}

/// What `bv=intersection` means.
using IntersectionVolume = Intersection<AabbVolume, ObbVolume>;
extern template class Intersection<AabbVolume, ObbVolume>;
static_assert(sizeof(IntersectionVolume) == 84 && BoundingVolume<IntersectionVolume>);

}  // namespace strahl
