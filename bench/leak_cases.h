// bench/leak_cases.h - a closed sphere near and far from the origin, float32 rays from inside it at
// its corners, edges and faces, and the tally of what an engine gets wrong: the true answer is
// always one crossing.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>

namespace strahl::leaks {

/// Icosphere of 81,920 triangles, moved along (1, 1, 1), its vertices rounded to float32.
struct Sphere {
  const char* name;
  double radius, offset;
};
inline constexpr std::array<Sphere, 4> kSpheres{{{"r=1 at 0", 1, 0},
                                                 {"r=1 at 1e3", 1, 1e3},
                                                 {"r=1000 at 1e5", 1000, 1e5},
                                                 {"r=1000 at 1e6", 1000, 1e6}}};

enum class Aim { vertex, edge, random };
inline constexpr std::array<Aim, 3> kAims{Aim::vertex, Aim::edge, Aim::random};
inline const char* name_of(Aim aim) {
  return aim == Aim::vertex ? "vertices" : aim == Aim::edge ? "edge midpoints" : "random points";
}

inline TriangleMesh make_mesh_of(const Sphere& sphere) {
  const SceneData unit_sphere = generate_scene("icosphere:6");
  const TriangleMesh& mesh = unit_sphere.geometries.at(0).mesh;
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < mesh.vertices.count; ++i)
    vertices.push_back(Vec3f(sphere.radius * mesh.vertices[i] + Vec3d::all(sphere.offset)));
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t v : {t.a, t.b, t.c}) indices.push_back(static_cast<std::uint32_t>(v));
  }
  if (indices.size() != 3 * 81920) throw std::logic_error("the icosphere has changed");
  return make_mesh(std::move(vertices), std::move(indices));
}

struct FloatRay {
  Vec3f org, dir;
};

/// From random points within half the radius; dir = target - org, rounded to float32.
inline std::vector<FloatRay> make_rays(const Sphere& sphere, const TriangleMesh& mesh, Aim aim,
                                       std::size_t count) {
  Rng rng(static_cast<std::uint64_t>(aim) + 1);
  const auto inside = [&] {
    Vec3d p;
    do {
      for (int axis = 0; axis < 3; ++axis) p[axis] = rng.uniform(-0.5, 0.5);
    } while (dot(p, p) > 0.25);
    return sphere.radius * p + Vec3d::all(sphere.offset);
  };
  const auto target = [&](const TriangleVertices& t) {
    if (aim == Aim::vertex) return t.a;
    if (aim == Aim::edge) return 0.5 * (t.a + t.b);
    double u = rng.uniform(), v = rng.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return t.a + u * (t.b - t.a) + v * (t.c - t.a);
  };
  std::vector<FloatRay> rays(count);
  for (FloatRay& ray : rays) {
    ray.org = Vec3f(inside());
    ray.dir = Vec3f(target(mesh[rng.below(static_cast<std::uint32_t>(mesh.size()))])) - ray.org;
  }
  return rays;
}

/// The rays as a batch over their own memory.
inline RayBatch batch_of(const std::vector<FloatRay>& rays) {
  const auto* base = reinterpret_cast<const std::byte*>(rays.data());
  RayBatch batch;
  batch.org = {base, rays.size(), sizeof(FloatRay), false};
  batch.dir = {base + sizeof(Vec3f), rays.size(), sizeof(FloatRay), false};
  return batch;
}

/// What went wrong: rays without any hit, with another number of hits than 1, with an even number.
struct Tally {
  std::uint64_t rays = 0, leaks = 0, wrong_counts = 0, wrong_parities = 0;

  void add(bool is_hit, std::uint32_t count) {
    ++rays, leaks += !is_hit, wrong_counts += count != 1, wrong_parities += count % 2 == 0;
  }
  bool is_clean() const { return leaks + wrong_counts + wrong_parities == 0; }
};

inline Tally tally(const Accelerator& accelerator, const std::vector<FloatRay>& rays,
                   const BatchContext& context = {}) {
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  std::vector<std::uint32_t> counts(rays.size());
  accelerator.closest_hit(batch_of(rays), hits, context);
  accelerator.any_hit(batch_of(rays), any, context);
  accelerator.count_hits(batch_of(rays), counts, context);
  Tally sum;
  for (std::size_t i = 0; i < rays.size(); ++i) sum.add(hits[i].is_hit() && any[i] != 0, counts[i]);
  return sum;
}

}  // namespace strahl::leaks
