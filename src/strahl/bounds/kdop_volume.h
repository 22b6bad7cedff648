// bounds/kdop_volume.h - k-DOPs: intersections of k/2 slabs across fixed directions.
//
// Papers:     [KayKajiya1986] (slabs), [Klosowski1998] (the name and the sets of directions).
// Layout:     k floats rounded outward: 24, 56, 72, 104 bytes. Directions: 3 axes; for 14 and 26
// the 4
//             cube diagonals; for 18 and 26 the 6 face diagonals; with components -1, 0, 1. The
//             directions of 6 are among those of 14 and 18, theirs among those of 26, and a slab
//             depends on nothing else: a k-DOP is within the k'-DOP of fewer of its directions.
// Ray:        the products with the directions are made once per ray; a test is k/2 slabs.
// Margins:    bound_margin.h with |n|_1 = 1, 2 or 3.
// Measure:    of the polytope, O(k^2); merge() is exact: the k-DOP of the union.
// Thread safety: values.
#pragma once

#include <array>

#include <strahl/bounds/bound_ray.h>
#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/polytope.h>

namespace strahl {

/// The 13 directions with components -1, 0, 1: axes, cube diagonals, face diagonals.
inline constexpr std::array<Vec3d, 13> kDopDirections{
    Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1},  {1, 1, -1}, {1, -1, 1}, {-1, 1, 1},
    {1, 1, 0},      {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};

/// Direction i of a k-DOP.
template <int K>
constexpr const Vec3d& dop_direction(std::size_t i) {
  return kDopDirections[K == 18 && i >= 3 ? i + 4 : i];
}

template <int K>
struct KdopRay {
  std::array<SlabRay, K / 2> slab;
  KdopRay() = default;
  KdopRay(const PreparedRay& ray, const Aabb& world) {
    const BoundRay bound(ray, world);
    for (std::size_t i = 0; i < K / 2; ++i)
      slab[i] = SlabRay(bound, dop_direction<K>(i), norm1(dop_direction<K>(i)));
  }
};

template <int K>
class KdopVolume {
  static_assert(K == 6 || K == 14 || K == 18 || K == 26);

 public:
  static constexpr BoundingVolumeKind kKind = K == 6    ? BoundingVolumeKind::kdop6
                                              : K == 14 ? BoundingVolumeKind::kdop14
                                              : K == 18 ? BoundingVolumeKind::kdop18
                                                        : BoundingVolumeKind::kdop26;
  using RayData = KdopRay<K>;

  KdopVolume();
  static KdopVolume enclose(const EnclosedSet& set, FitEffort = FitEffort::fast);
  static KdopVolume merge(const KdopVolume& a, const KdopVolume& b);

  Interval clip(const RayData& ray, Interval in) const {
    for (std::size_t i = 0; i < K / 2; ++i) in = clip_to_slab(ray.slab[i], lo_[i], hi_[i], in);
    return in;
  }
  double half_area() const { return measure().half_area; }
  double volume() const { return measure().volume; }
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this); }
  Aabb box() const { return {{lo_[0], lo_[1], lo_[2]}, {hi_[0], hi_[1], hi_[2]}}; }
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;
  void add_planes_to(Polytope& body) const;

 private:
  Polytope::Measure measure() const;
  std::array<float, K / 2> lo_, hi_;
};

extern template class KdopVolume<6>;
extern template class KdopVolume<14>;
extern template class KdopVolume<18>;
extern template class KdopVolume<26>;
static_assert(sizeof(KdopVolume<6>) == 24 && sizeof(KdopVolume<26>) == 104);
static_assert(PolyhedralVolume<KdopVolume<14>>);

}  // namespace strahl
