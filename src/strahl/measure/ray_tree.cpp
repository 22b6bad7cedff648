#include <cmath>
#include <optional>
#include <utility>

#include <strahl/measure/ray_tree.h>
#include <strahl/render/look.h>

namespace strahl {
namespace {

constexpr int kMaxDepth = 5;
/// Distance along a ray at which it may meet a surface again.
constexpr double kOffset = 1e-6;

/// What a ray found, with everything its offspring depends on.
struct TreeHit {
  Vec3d position, dir, normal;  ///< unit; the normal towards where the ray came from
  bool is_entering;             ///< the front side was hit
  const Material& material;
};

Ray leaving(const Vec3d& from, const Vec3d& dir) { return {from, dir, kOffset}; }

Vec3d reflected(const TreeHit& hit) {
  return hit.dir - 2.0 * dot(hit.dir, hit.normal) * hit.normal;
}

/// By Snell's law; empty at total reflection.
std::optional<Vec3d> refracted(const TreeHit& hit) {
  const double index = hit.material.refraction_index;
  const double ratio = hit.is_entering ? 1.0 / index : index;
  const double cosine = -dot(hit.dir, hit.normal);
  const double rest = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (!(rest >= 0.0)) return std::nullopt;
  return normalized(ratio * hit.dir + (ratio * cosine - std::sqrt(rest)) * hit.normal);
}

/// A lamp lights the outer side of what transmits, whichever side the ray came from.
Vec3d lit_side(const TreeHit& hit) {
  const bool is_inner = hit.material.transmission > 0.0 && !hit.is_entering;
  return is_inner ? -hit.normal : hit.normal;
}

void add_shadow_rays(const TreeHit& hit, const std::vector<Vec3d>& lamps, std::vector<Ray>& out) {
  const Vec3d normal = lit_side(hit);
  for (const Vec3d& lamp : lamps) {
    const Vec3d to_lamp = lamp - hit.position;
    if (dot(to_lamp, normal) > 0.0)
      out.push_back({hit.position, to_lamp, kOffset / length(to_lamp), 1.0});
  }
}

void add_offspring(const TreeHit& hit, std::vector<Ray>& out) {
  const Material& m = hit.material;
  if (m.specular > 0.0 || m.transmission > 0.0)
    out.push_back(leaving(hit.position, reflected(hit)));
  if (!(m.transmission > 0.0)) return;
  if (const auto dir = refracted(hit)) out.push_back(leaving(hit.position, *dir));
}

}  // namespace

Workload make_ray_tree(const Accelerator& accelerator, std::vector<Ray> eye_rays,
                       const BuildContext& context) {
  const Scene& scene = accelerator.scene();
  Workload tree{WorkloadKind::whitted, {}, {}, eye_rays.size()};
  std::vector<Ray> level = std::move(eye_rays);
  for (int depth = 1; !level.empty(); ++depth) {
    std::vector<Hit> hits(level.size());
    accelerator.closest_hit(make_batch(level), hits, {context, false});
    std::vector<Ray> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (!hits[i].is_hit()) continue;
      const SurfacePoint point = surface_point(scene, level[i], hits[i]);
      const TreeHit hit{point.position, normalized(level[i].dir), point.normal, hits[i].is_front,
                        material_of(scene, hits[i])};
      add_shadow_rays(hit, scene.data().lights, tree.any);
      if (depth < kMaxDepth) add_offspring(hit, next);
    }
    tree.closest.insert(tree.closest.end(), level.begin(), level.end());
    level = std::move(next);
  }
  return tree;
}

}  // namespace strahl
