// bounds/bounding_volume.h - what every kind of bounding volume offers, and the list of kinds.
//
// A structure over bounding volumes is a template over one type V of this concept and is
// instantiated per kind. Values:
//   V{}                   the empty volume: contains nothing, every ray misses it
//   V::enclose(set, e)    a volume around all of the set; never fails, see below
//   V::merge(a, b)        a volume around both volumes, for building bottom-up
//   V::RayData(ray, w)    made once per ray; w encloses all that any volume encloses. Refers to the
//                         prepared ray, which must outlive it
//   v.clip(ray_data, in)  the part of `in` in which the ray may be inside: empty only for a certain
//                         miss, NaN cuts nothing (bound_margin.h has the proof)
//   v.half_area()         half the surface of the convex volume: the chance of a random line to
//   meet
//                         it. Where the volume is not convex, that of its hull, as documented there
//   v.volume()
//   v.contains(p)         in double without margin; true of all points that were enclosed
//   v.bytes()             of the object with all it owns
//   v.add_corners_to(set) points and balls whose hull encloses the volume
//   v.add_sides_to(list)  its boundary, for measures (side.h)
// Storage is float, rounded outward. Beyond float's range a volume may be without end: then it is
// met by every ray, and its measures are infinite or NaN.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string_view>

#include <strahl/bounds/fit.h>
#include <strahl/bounds/side.h>
#include <strahl/math/ray.h>

namespace strahl {

enum class BoundingVolumeKind : std::uint8_t {
  aabb,
  sphere,
  obb,
  kdop6,
  kdop14,
  kdop18,
  kdop26,
  cylinder,
  hull,
  prism,
  shell,
  intersection
};

struct BoundingVolumeInfo {
  BoundingVolumeKind kind;
  std::string_view name;  ///< as in a SPEC
  std::string_view title;
};

/// All kinds in the order of the enumeration.
inline constexpr std::array<BoundingVolumeInfo, 12> kBoundingVolumes{{
    {BoundingVolumeKind::aabb, "aabb", "axis-aligned box"},
    {BoundingVolumeKind::sphere, "sphere", "smallest sphere"},
    {BoundingVolumeKind::obb, "obb", "oriented box"},
    {BoundingVolumeKind::kdop6, "kdop6", "6-DOP: slabs across the axes"},
    {BoundingVolumeKind::kdop14, "kdop14", "14-DOP: axes and cube diagonals"},
    {BoundingVolumeKind::kdop18, "kdop18", "18-DOP: axes and face diagonals"},
    {BoundingVolumeKind::kdop26, "kdop26", "26-DOP: axes and both diagonals"},
    {BoundingVolumeKind::cylinder, "cylinder", "capped cylinder"},
    {BoundingVolumeKind::hull, "hull", "convex hull, simplified outward"},
    {BoundingVolumeKind::prism, "prism", "right prism over a convex polygon"},
    {BoundingVolumeKind::shell, "shell", "sector of a spherical shell"},
    {BoundingVolumeKind::intersection, "intersection", "axis-aligned and oriented box"},
}};

constexpr const BoundingVolumeInfo& info_of(BoundingVolumeKind kind) {
  return kBoundingVolumes[static_cast<std::size_t>(kind)];
}

template <class V>
concept BoundingVolume = std::default_initializable<V> && std::copyable<V> &&
    std::constructible_from<typename V::RayData, const PreparedRay&, const Aabb&> &&
    requires(const V& v, const EnclosedSet& set, FitEffort effort, const typename V::RayData& ray,
             Interval in, const Vec3d& p, EnclosedSet& out, SideList& sides) {
  { V::kKind } -> std::convertible_to<BoundingVolumeKind>;
  { V::enclose(set, effort) } -> std::same_as<V>;
  { V::merge(v, v) } -> std::same_as<V>;
  { v.clip(ray, in) } -> std::same_as<Interval>;
  { v.half_area() } -> std::same_as<double>;
  { v.volume() } -> std::same_as<double>;
  { v.contains(p) } -> std::same_as<bool>;
  { v.bytes() } -> std::same_as<std::size_t>;
  v.add_corners_to(out);
  v.add_sides_to(sides);
};

/// A volume bounded by planes, so that intersections of such can be measured.
template <class V>
concept PolyhedralVolume = BoundingVolume<V> && requires(const V& v, class Polytope& body) {
  { v.box() } -> std::same_as<Aabb>;
  v.add_planes_to(body);
};

/// A volume of kind V around two of it, made anew around their corners.
template <class V>
V merge_by_corners(const V& a, const V& b) {
  EnclosedSet both;
  a.add_corners_to(both), b.add_corners_to(both);
  return V::enclose(both, FitEffort::fast);
}

}  // namespace strahl
