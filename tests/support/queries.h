// tests/support/queries.h - what tests ask of every structure of the catalogue, and how they
// compare and print hits.
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <ostream>
#include <span>
#include <utility>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>

namespace strahl {

/// For GoogleTest's messages.
inline void PrintTo(const Hit& hit, std::ostream* out) {
  *out << std::hexfloat << "t " << hit.t << std::defaultfloat << " (" << hit.id.inst << ' '
       << hit.id.geom << ' ' << hit.id.prim << ") front " << hit.is_front;
}

namespace test {

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Vec3d& a, const Vec3d& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
/// The bits of a hit that are part of the contract.
inline bool same_bits(const Hit& a, const Hit& b) {
  return same_bits(a.t, b.t) && a.id == b.id && a.is_front == b.is_front &&
         a.reference == b.reference;
}
inline bool same_bits(const HitSurface& a, const HitSurface& b) {
  return same_bits(a.u, b.u) && same_bits(a.v, b.v) && same_bits(a.normal, b.normal) &&
         a.face_id == b.face_id;
}

/// A scene of one mesh, or of one mesh under these maps, with ids 0, 1, ...
inline std::shared_ptr<const Scene> scene_of(TriangleMesh mesh,
                                             const std::vector<Affine>& maps = {}) {
  SceneData data;
  data.geometries.resize(1);
  data.geometries[0].mesh = std::move(mesh);
  for (const Affine& map : maps)
    data.instances.push_back({0, 1, map, static_cast<std::uint32_t>(data.instances.size())});
  return std::make_shared<const Scene>(std::move(data));
}

/// Every structure of the catalogue with its default options, brute force first.
inline std::vector<std::unique_ptr<Accelerator>> build_all(
    const std::shared_ptr<const Scene>& scene) {
  std::vector<std::unique_ptr<Accelerator>> built;
  for (const StructureEntry& entry : all_structures()) built.push_back(build(scene, entry.name));
  return built;
}

inline std::vector<Hit> closest_hits(const Accelerator& accelerator, const RayBatch& rays) {
  std::vector<Hit> hits(rays.size());
  accelerator.closest_hit(rays, hits);
  return hits;
}
inline std::vector<std::uint32_t> hit_counts(const Accelerator& accelerator, const RayBatch& rays) {
  std::vector<std::uint32_t> counts(rays.size());
  accelerator.count_hits(rays, counts);
  return counts;
}
inline std::vector<std::uint8_t> any_hits(const Accelerator& accelerator, const RayBatch& rays) {
  std::vector<std::uint8_t> any(rays.size());
  accelerator.any_hit(rays, any);
  return any;
}
inline AllHits all_hits(const Accelerator& accelerator, const RayBatch& rays) {
  AllHits hits;
  accelerator.all_hits(rays, hits);
  return hits;
}
inline std::vector<Side> sides_of(const Accelerator& accelerator, const RayBatch& rays) {
  std::vector<Side> sides(rays.size());
  accelerator.inside(rays, sides);
  return sides;
}

/// The hits of ray i.
inline std::span<const Hit> hits_of(const AllHits& all, std::size_t i) {
  const auto first = static_cast<std::size_t>(all.splits[i]);
  return std::span(all.hits).subspan(first, static_cast<std::size_t>(all.splits[i + 1]) - first);
}

}  // namespace test
}  // namespace strahl
