#include <algorithm>
#include <cmath>
#include <tests/conformance/rays.h>

#include <strahl/base/rng.h>

namespace strahl::test {
namespace {

/// Draws points that matter: corners, edge points and centres of triangles, box corners.
class Targets {
 public:
  Targets(const Scene& scene, Rng& rng) : scene_(scene), rng_(rng) {
    box_ = scene.total_bounds();
    if (box_.is_empty()) box_ = {{-1, -1, -1}, {1, 1, 1}};
  }
  TriangleVertices triangle() {
    for (int tries = 0; tries < 8 && scene_.size() > 0; ++tries) {
      const std::uint32_t reference = rng_.below(scene_.size());
      const Part& part = scene_.part_of(reference);
      const Geometry& g = scene_.geometries()[part.geometry];
      if (g.kind != PrimitiveKind::triangle || scene_.bounds(reference).is_empty()) continue;
      const TriangleVertices t = g.mesh[reference - part.first_reference];
      const Affine& map = scene_.instances()[part.instance].to_world;
      return {map.point(t.a), map.point(t.b), map.point(t.c)};
    }
    return {in_box(1.0), in_box(1.0), in_box(1.0)};
  }
  Vec3d in_box(double scale) {
    const Vec3d e = box_.extent() * scale, c = box_.center();
    const double x = rng_.uniform(-0.5, 0.5) * e.x, y = rng_.uniform(-0.5, 0.5) * e.y;
    return c + Vec3d{x, y, rng_.uniform(-0.5, 0.5) * e.z};
  }
  Vec3d direction() {
    const double x = rng_.uniform(-1, 1), y = rng_.uniform(-1, 1);
    return {x, y, rng_.uniform(-1, 1)};
  }
  double size() const { return std::max(1e-6, norm_max(box_.extent())); }

 private:
  const Scene& scene_;
  Rng& rng_;
  Aabb box_;
};

Vec3d axis_vector(int axis, double length) {
  Vec3d v;
  v[axis] = length;
  return v;
}

Ray towards(const Vec3d& org, const Vec3d& target) { return {org, target - org}; }

Ray make_ray(std::size_t kind, Targets& targets, Rng& rng) {
  const TriangleVertices t = targets.triangle();
  const int axis = static_cast<int>(rng.below(3));
  const double sign = rng.below(2) ? 1.0 : -1.0;
  switch (kind) {
    case 0:
      return {targets.in_box(1.0), targets.direction()};
    case 1:
      return towards(targets.in_box(3.0), t.a);
    case 2:
      return towards(targets.in_box(3.0), 0.5 * (t.a + t.b));
    case 3:  // along an edge
      return {t.a - 2.0 * (t.b - t.a), t.b - t.a};
    case 4:  // from a corner
      return {t.c, targets.direction()};
    case 5:  // in the plane of the face, from inside it
      return {(t.a + t.b + t.c) / 3.0, t.b - t.a};
    case 6:  // axis-parallel through a corner
      return {t.b - axis_vector(axis, sign * 4 * targets.size()), axis_vector(axis, sign)};
    case 7:  // axis-parallel from a corner
      return {t.a, axis_vector(axis, sign)};
    case 8:  // diagonal in a coordinate plane through a corner
      return {t.a, axis_vector(axis, sign) + axis_vector((axis + 1) % 3, 1.0)};
    case 9:  // far away, aimed at a corner
      return towards(targets.in_box(1.0) + 1e6 * targets.size() * targets.direction(), t.a);
    case 10:  // very far away
      return towards(1e12 * targets.direction(), t.a);
    case 11:  // from one corner to another: the interval ends on a surface
      return {t.a, targets.triangle().b - t.a, 0.0, 1.0};
    case 12:  // zero-length interval on a surface
      return {t.a, targets.direction(), 0.0, 0.0};
    case 13: {  // interval that begins beyond the start
      Ray r = towards(targets.in_box(2.0), targets.in_box(1.0));
      r.t_min = rng.uniform(), r.t_max = r.t_min + rng.uniform() - 0.1;
      return r;
    }
    case 14:  // tiny and huge directions
      return {targets.in_box(2.0),
              targets.direction() * std::ldexp(1.0, static_cast<int>(rng.below(120)) - 60)};
    case 15: {  // axis-parallel beside a corner from very far: only widened boxes are met for sure
      const double distance = std::ldexp(1e9, static_cast<int>(rng.below(11)));
      const Vec3d beside = t.c + std::ldexp(distance, -52) * targets.direction();
      return {beside - axis_vector(axis, sign * distance), axis_vector(axis, sign)};
    }
    default:
      return towards(targets.in_box(3.0), targets.in_box(1.0));
  }
}

void add_invalid(std::vector<Ray>& rays) {
  const double nan = std::nan(""), inf = Aabb::kInf;
  const Ray good{{0.1, 0.2, 5}, {0, 0, -1}};
  for (int i = 0; i < 8; ++i) rays.push_back(good);
  const std::size_t n = rays.size();
  rays[n - 8].org.x = nan, rays[n - 7].dir.y = inf, rays[n - 6].dir = {0, -0.0, 0};
  rays[n - 5].t_min = -1, rays[n - 4].t_max = nan, rays[n - 3].t_min = inf;
  rays[n - 2].t_min = 2, rays[n - 2].t_max = 1;  // valid, hits nothing
  rays[n - 1].org.z = 1e300;
}

}  // namespace

RayBatch RaySet::batch(bool filtered) const {
  RayBatch batch = make_batch(rays);
  if (!filtered) return batch;
  batch.masks = masks, batch.excluded = excluded, batch.after = after, batch.cull_per_ray = cull;
  return batch;
}

RaySet adversarial_rays(const Scene& scene, std::size_t count, std::uint64_t seed) {
  constexpr std::size_t kKinds = 17;
  Rng rng(seed);
  Targets targets(scene, rng);
  RaySet set;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray = make_ray(i % kKinds, targets, rng);
    if (rng.below(4) == 0) ray.org = Vec3d(Vec3f(ray.org)), ray.dir = Vec3d(Vec3f(ray.dir));
    set.rays.push_back(ray);
  }
  add_invalid(set.rays);
  bind_filters(set, {}, seed);
  return set;
}

void bind_filters(RaySet& set, std::span<const Hit> first_hits, std::uint64_t seed) {
  Rng rng(seed, 7);
  const std::size_t n = set.rays.size();
  set.masks.assign(n, ~0u), set.cull.assign(n, 0);
  set.excluded.assign(n, {kNoId, kNoId, kNoId});
  set.after.assign(n, {-1.0, {0, 0, 0}});
  for (std::size_t i = 0; i < n; ++i) {
    const Hit hit = i < first_hits.size() ? first_hits[i] : Hit{};
    set.cull[i] = rng.below(2) == 0;
    if (rng.below(8) == 0) set.masks[i] = 0;
    if (!hit.is_hit()) continue;
    if (rng.below(2)) set.excluded[i] = hit.id;
    if (rng.below(2)) set.after[i] = {hit.t, hit.id};
  }
}

}  // namespace strahl::test
