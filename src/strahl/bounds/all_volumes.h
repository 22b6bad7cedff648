// bounds/all_volumes.h - every kind as a type, for code that is made once per kind.
#pragma once

#include <utility>

#include <strahl/bounds/aabb_volume.h>
#include <strahl/bounds/cylinder_volume.h>
#include <strahl/bounds/hull_volume.h>
#include <strahl/bounds/intersection_volume.h>
#include <strahl/bounds/kdop_volume.h>
#include <strahl/bounds/obb_volume.h>
#include <strahl/bounds/prism_volume.h>
#include <strahl/bounds/shell_volume.h>
#include <strahl/bounds/sphere_volume.h>

namespace strahl {

/// Calls f.template operator()<V>() with the type of a kind.
template <class F>
decltype(auto) with_volume_type(BoundingVolumeKind kind, F&& f) {
  using Kind = BoundingVolumeKind;
  switch (kind) {
    case Kind::aabb:
      return f.template operator()<AabbVolume>();
    case Kind::sphere:
      return f.template operator()<SphereVolume>();
    case Kind::obb:
      return f.template operator()<ObbVolume>();
    case Kind::kdop6:
      return f.template operator()<KdopVolume<6>>();
    case Kind::kdop14:
      return f.template operator()<KdopVolume<14>>();
    case Kind::kdop18:
      return f.template operator()<KdopVolume<18>>();
    case Kind::kdop26:
      return f.template operator()<KdopVolume<26>>();
    case Kind::cylinder:
      return f.template operator()<CylinderVolume>();
    case Kind::hull:
      return f.template operator()<HullVolume>();
    case Kind::prism:
      return f.template operator()<PrismVolume>();
    case Kind::shell:
      return f.template operator()<ShellVolume>();
    case Kind::intersection:
      break;
  }
  return f.template operator()<IntersectionVolume>();
}

}  // namespace strahl
