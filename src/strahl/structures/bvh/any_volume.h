// structures/bvh/any_volume.h - a bounding volume whose kind is its own: for hierarchies in which
// every node has the kind that suits it.
//
// Layout:     boxes and spheres lie in the object itself, larger kinds behind a pointer: 32 bytes.
// Ray:        what a kind needs once per ray is made when the first volume of that kind is met.
// Thread safety: as for other volumes; one RayData per thread.
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include <strahl/bounds/all_volumes.h>

namespace strahl {

namespace any_volume_detail {

template <class V>
inline constexpr bool kIsSmall = sizeof(V) <= sizeof(AabbVolume) && std::is_trivially_copyable_v<V>;

template <class V>
using Held = std::conditional_t<kIsSmall<V>, V, std::unique_ptr<const V>>;

/// F<V...> for all kinds in the order of BoundingVolumeKind.
template <template <class...> class F>
using OverKinds =
    F<AabbVolume, SphereVolume, ObbVolume, KdopVolume<6>, KdopVolume<14>, KdopVolume<18>,
      KdopVolume<26>, CylinderVolume, HullVolume, PrismVolume, ShellVolume, IntersectionVolume>;

template <class... V>
using HeldVariant = std::variant<Held<V>...>;
template <class... V>
using RayTuple = std::tuple<std::optional<typename V::RayData>...>;

}  // namespace any_volume_detail

/// The rays of all kinds; the prepared ray and the world must outlive it.
class AnyRay {
 public:
  AnyRay(const PreparedRay& ray, const Aabb& world) : ray_(ray), world_(world) {}

  template <class V>
  const typename V::RayData& of() const {
    auto& own = std::get<static_cast<std::size_t>(V::kKind)>(made_);
    if (!own) own.emplace(ray_, world_);
    return *own;
  }

 private:
  const PreparedRay& ray_;
  const Aabb& world_;
  mutable any_volume_detail::OverKinds<any_volume_detail::RayTuple> made_;
};

class AnyVolume {
 public:
  using RayData = AnyRay;

  AnyVolume() = default;  ///< an empty box
  // Not of itself: clang would ask whether it is copyable to find out whether it is copyable.
  template <class V>
  requires(!std::same_as<V, AnyVolume>) && BoundingVolume<V> explicit AnyVolume(V volume) {
    constexpr auto kIndex = static_cast<std::size_t>(V::kKind);
    if constexpr (any_volume_detail::kIsSmall<V>)
      held_.template emplace<kIndex>(std::move(volume));
    else
      held_.template emplace<kIndex>(std::make_unique<const V>(std::move(volume)));
  }

  BoundingVolumeKind kind() const { return static_cast<BoundingVolumeKind>(held_.index()); }
  Interval clip(const AnyRay& ray, Interval in) const {
    return with_volume_type(kind(), [&]<class V>() { return get<V>().clip(ray.of<V>(), in); });
  }
  double half_area() const {
    return with_volume_type(kind(), [&]<class V>() { return get<V>().half_area(); });
  }
  double volume() const {
    return with_volume_type(kind(), [&]<class V>() { return get<V>().volume(); });
  }
  bool contains(const Vec3d& p) const {
    return with_volume_type(kind(), [&]<class V>() { return get<V>().contains(p); });
  }
  void add_corners_to(EnclosedSet& set) const {
    with_volume_type(kind(), [&]<class V>() { get<V>().add_corners_to(set); });
  }
  void add_sides_to(SideList& sides) const {
    with_volume_type(kind(), [&]<class V>() { get<V>().add_sides_to(sides); });
  }
  std::size_t bytes() const {
    return sizeof(*this) + with_volume_type(kind(), [&]<class V>() {
             return any_volume_detail::kIsSmall<V> ? 0 : get<V>().bytes();
           });
  }

 private:
  template <class V>
  const V& get() const {
    const auto& held = *std::get_if<static_cast<std::size_t>(V::kKind)>(&held_);
    if constexpr (any_volume_detail::kIsSmall<V>)
      return held;
    else
      return *held;
  }

  any_volume_detail::OverKinds<any_volume_detail::HeldVariant> held_;
};
static_assert(sizeof(AnyVolume) == 32);

}  // namespace strahl
