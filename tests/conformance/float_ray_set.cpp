#include <cmath>
#include <cstddef>
#include <tests/conformance/float_ray_set.h>
#include <tests/conformance/oracle.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>

namespace strahl::test {

FloatRaySet::FloatRaySet(const RaySet& set) {
  for (std::size_t i = 0; i < set.rays.size(); ++i) {
    Ray ray = set.rays[i];
    const double size = length(ray.dir);
    if (i % 3 != 0 && size > 0.0 && std::isfinite(size))
      ray.dir = ray.dir / size, ray.t_min *= size, ray.t_max *= size;
    if (i % 10 == 1) ray.dir.x = i % 20 == 1 ? -0.0 : 0.0;
    records.push_back({Vec3f(ray.org), static_cast<float>(ray.t_min), Vec3f(ray.dir),
                       static_cast<float>(ray.t_max)});
  }
}

FloatRaySet FloatRaySet::bundles(const RaySet& set, std::uint64_t seed) {
  const FloatRaySet all(set);
  FloatRaySet out;
  Rng rng(seed);
  for (std::size_t i = 0; i < all.records.size() / 64; ++i) {
    const double spread = std::ldexp(1.0, -static_cast<int>(rng.below(14)));
    const auto near = [&](const Vec3f& v, bool moves) {
      if (!moves) return v;
      const double size = spread * norm_max(Vec3d(v));
      return Vec3f(Vec3d(v) + Vec3d{rng.uniform(-size, size), rng.uniform(-size, size),
                                    rng.uniform(-size, size)});
    };
    const Record& base = all.records[i];
    for (int k = 0; k < 64; ++k)
      out.records.push_back({near(base.org, i % 3 != 0), base.t_min, near(base.dir, i % 3 != 1),
                             k % 16 == 5 ? base.t_max / 2 : base.t_max});
  }
  return out;
}

FloatRaySet FloatRaySet::fans(const RaySet& set, const Scene& scene, std::uint64_t seed) {
  const FloatRaySet all(set);
  const TriangleMesh& mesh = scene.geometries().front().mesh;
  const double size = norm_max(scene.total_bounds().extent());
  FloatRaySet out;
  Rng rng(seed);
  const auto within = [&](double reach) {
    return Vec3d{rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                 rng.uniform(-reach, reach)};
  };
  for (std::size_t i = 0; i < all.records.size() / 64; ++i) {
    const Vec3f org = all.records[i].org;
    const double reach = std::ldexp(size, -static_cast<int>(rng.below(9)));
    const auto first = static_cast<std::size_t>(rng.below(static_cast<std::uint32_t>(mesh.size())));
    for (std::size_t k = 0; k < 64; ++k) {
      if (i % 2 == 0)
        out.records.push_back({Vec3f(Vec3d(org) + within(0.1 * reach)), 0.0f, Vec3f(within(reach)),
                               k % 16 == 5 ? 0.25f : 1.0f});
      else
        out.records.push_back({org, 0.0f, Vec3f(mesh[(first + k / 3) % mesh.size()].b - Vec3d(org)),
                               k % 16 == 5 ? 1.0f : 2.0f});
    }
  }
  return out;
}

FloatRaySet FloatRaySet::from_places(const RaySet& set, const Scene& scene, std::uint64_t seed) {
  const FloatRaySet all(set);
  const Aabb box = scene.total_bounds();
  FloatRaySet out;
  Rng rng(seed);
  for (std::size_t i = 0; i < all.records.size() / 16; ++i) {
    const Vec3d from = i % 3 == 0 ? box.center() : Vec3d(all.records[i].org);
    const double spread = std::ldexp(1.0, -static_cast<int>(rng.below(5)));
    const Vec3d aim = box.lo + box.extent() * rng.uniform(0, 1);
    for (int k = 0; k < 64; ++k) {
      Vec3d org = from;
      if (i % 2 == 1) org[static_cast<int>(i / 2 % 3)] += 0.01 * rng.uniform(-1, 1);
      const Vec3d off{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
      out.records.push_back(
          {Vec3f(org), 0.0f, Vec3f(aim + spread * norm_max(box.extent()) * off - org), 4.0f});
    }
  }
  return out;
}

RayBatch FloatRaySet::batch() const {
  const auto* base = reinterpret_cast<const std::byte*>(records.data());
  constexpr std::size_t kStride = sizeof(Record);
  RayBatch batch;
  batch.org = {base + offsetof(Record, org), records.size(), kStride, false};
  batch.dir = {base + offsetof(Record, dir), records.size(), kStride, false};
  batch.t_min = ScalarView{base + offsetof(Record, t_min), kStride, false};
  batch.t_max = ScalarView{base + offsetof(Record, t_max), kStride, false};
  return batch;
}

void expect_like_bvh(const std::shared_ptr<const Scene>& scene, const FloatRaySet& rays,
                     std::initializer_list<const char*> specs) {
  const std::size_t n = rays.records.size();
  std::vector<Hit> expected(n), got(n);
  std::vector<std::uint8_t> any(n);
  const BatchReport report = build(scene, "bvh")->closest_hit(rays.batch(), expected);
  for (const char* spec : specs) {
    const auto wide = build(scene, spec);
    EXPECT_EQ(wide->closest_hit(rays.batch(), got).invalid_rays, report.invalid_rays);
    wide->any_hit(rays.batch(), any);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_TRUE(have_same_bits(got[i], expected[i])) << spec << " ray " << i;
      ASSERT_EQ(any[i] != 0, expected[i].is_hit()) << spec << " ray " << i;
    }
  }
}

}  // namespace strahl::test
