// Float rays as records of a caller, read in place: those that packets and flights share out.
#pragma once

#include <initializer_list>
#include <memory>
#include <tests/conformance/rays.h>
#include <vector>

namespace strahl::test {

/// Unit and other float rays, which take a shorter way than doubles.
struct FloatRaySet {
  struct Record {
    Vec3f org;
    float t_min;
    Vec3f dir;
    float t_max;
  };
  std::vector<Record> records;

  FloatRaySet() = default;
  explicit FloatRaySet(const RaySet& set);
  /// Blocks of 64 rays close to each of a set: from the same place, in the same direction, or
  /// neither.
  static FloatRaySet bundles(const RaySet& set, std::uint64_t seed);
  /// Blocks of 64 short rays in all directions from about each place of a set, and blocks from
  /// there to corners that follow each other in a mesh.
  static FloatRaySet fans(const RaySet& set, const Scene& scene, std::uint64_t seed);
  /// Blocks of 64 rays to all of the scene from the places of a set, or from there along an axis.
  static FloatRaySet from_places(const RaySet& set, const Scene& scene, std::uint64_t seed);

  /// Refers to this object.
  RayBatch batch() const;
};

/// Structures of these SPECs give closest and any hits of the same bits as bvh.
void expect_like_bvh(const std::shared_ptr<const Scene>& scene, const FloatRaySet& rays,
                     std::initializer_list<const char*> specs);

}  // namespace strahl::test
