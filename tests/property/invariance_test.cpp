// Answers follow from the bits of ray and scene alone: what must not change under a permutation of
// the primitives, a scaling by powers of two, another split of a batch or another layout in memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

namespace strahl::test {
namespace {

constexpr std::uint64_t kSeeds = 8;

using Corners = std::array<Vec3f, 3>;
using Triangles = std::vector<Corners>;

Vec3f random_point(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return Vec3f(Vec3d{x, y, rng.uniform(-reach, reach)});
}

/// Clustered soup with duplicates, a fan around one corner and integer coincidences.
Triangles random_triangles(Rng& rng) {
  Triangles triangles;
  const std::uint32_t count = 20 + rng.below(400);
  while (triangles.size() < count) {
    const Vec3f a = rng.below(4) == 0 ? Vec3f{0.5f, 0.5f, 0.5f} : random_point(rng, 1.0);
    Corners t{a, a + random_point(rng, 0.4), a + random_point(rng, 0.4)};
    if (rng.below(5) == 0)
      for (Vec3f& v : t)
        for (int axis = 0; axis < 3; ++axis) v[axis] = std::round(3 * v[axis]) / 4;
    triangles.push_back(t);
    if (rng.below(10) == 0) triangles.push_back({t[1], t[2], t[0]});
  }
  return triangles;
}

std::vector<Ray> random_rays(Rng& rng, const Triangles& triangles, std::size_t count) {
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Corners& t = triangles[rng.below(static_cast<std::uint32_t>(triangles.size()))];
    const Vec3f org = rng.below(6) == 0 ? t[1] : random_point(rng, 2.0);
    Vec3f dir = rng.below(2) ? t[0] - org : random_point(rng, 1.0);
    if (rng.below(4) == 0) dir[static_cast<int>(rng.below(3))] = 0.0f;
    if (dir != Vec3f{}) rays.push_back({Vec3d(org), Vec3d(dir)});
    if (rng.below(5) == 0 && !rays.empty()) rays.back().t_max = rng.uniform(0.0, 2.0);
  }
  return rays;
}

TriangleMesh mesh_of(const Triangles& triangles, double scale = 1.0) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (const Corners& t : triangles)
    for (const Vec3f& v : t) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(scale * Vec3d(v));
    }
  return make_mesh(std::move(vertices), std::move(indices));
}

class Invariance : public testing::TestWithParam<std::uint64_t> {
 protected:
  Rng rng_{GetParam()};
  Triangles triangles_ = random_triangles(rng_);
  std::vector<Ray> rays_ = random_rays(rng_, triangles_, 600);
};

void expect_same_hits(const AllHits& got, const AllHits& expected) {
  ASSERT_EQ(got.splits, expected.splits);
  for (std::size_t i = 0; i < got.hits.size(); ++i)
    ASSERT_TRUE(same_bits(got.hits[i], expected.hits[i])) << "hit " << i;
}

TEST_P(Invariance, PermutingPrimitivesPermutesTheIdsOnly) {
  std::vector<std::uint32_t> origin(triangles_.size());
  for (std::uint32_t i = 0; i < origin.size(); ++i) origin[i] = i;
  for (std::uint32_t i = static_cast<std::uint32_t>(origin.size()); i > 1; --i)
    std::swap(origin[i - 1], origin[rng_.below(i)]);
  Triangles permuted;
  for (const std::uint32_t i : origin) permuted.push_back(triangles_[i]);
  const auto plain = build_all(scene_of(mesh_of(triangles_)));
  const auto shuffled = build_all(scene_of(mesh_of(permuted)));
  for (std::size_t s = 0; s < plain.size(); ++s) {
    SCOPED_TRACE(plain[s]->spec());
    const AllHits expected = all_hits(*plain[s], make_batch(rays_));
    AllHits got = all_hits(*shuffled[s], make_batch(rays_));
    ASSERT_EQ(got.splits, expected.splits);
    for (Hit& hit : got.hits) hit.id.prim = hit.reference = origin[hit.id.prim];
    for (std::size_t i = 0; i + 1 < got.splits.size(); ++i)
      std::sort(got.hits.begin() + got.splits[i], got.hits.begin() + got.splits[i + 1],
                comes_before);
    expect_same_hits(got, expected);
  }
}

TEST_P(Invariance, ScalingSceneAndRaysByAPowerOfTwoKeepsIdsAndParameters) {
  const auto plain = build_all(scene_of(mesh_of(triangles_)));
  for (const int exponent : {-40, -7, 1, 13, 60}) {
    const double scale = std::ldexp(1.0, exponent);
    std::vector<Ray> both = rays_;
    for (Ray& ray : both) ray.org = scale * ray.org, ray.dir = scale * ray.dir;
    const auto scaled = build_all(scene_of(mesh_of(triangles_, scale)));
    for (std::size_t s = 0; s < plain.size(); ++s) {
      SCOPED_TRACE(plain[s]->spec() + " scaled by 2^" + std::to_string(exponent));
      const AllHits expected = all_hits(*plain[s], make_batch(rays_));
      expect_same_hits(all_hits(*scaled[s], make_batch(both)), expected);
    }
  }
}

TEST_P(Invariance, ScalingADirectionByAPowerOfTwoDividesTheParameters) {
  constexpr double kScale = 0x1p9;
  std::vector<Ray> fast = rays_;
  for (Ray& ray : fast) ray.dir = kScale * ray.dir, ray.t_max /= kScale;
  for (const auto& structure : build_all(scene_of(mesh_of(triangles_)))) {
    SCOPED_TRACE(structure->spec());
    AllHits got = all_hits(*structure, make_batch(fast));
    for (Hit& hit : got.hits) hit.t *= kScale;
    expect_same_hits(got, all_hits(*structure, make_batch(rays_)));
  }
}

TEST_P(Invariance, SplittingABatchAnywhereChangesNothing) {
  for (const auto& structure : build_all(scene_of(mesh_of(triangles_)))) {
    SCOPED_TRACE(structure->spec());
    const AllHits whole = all_hits(*structure, make_batch(rays_));
    const std::vector<Hit> closest = closest_hits(*structure, make_batch(rays_));
    for (std::size_t first = 0; first < rays_.size();) {
      const std::size_t n = std::min<std::size_t>(rays_.size() - first, rng_.below(97));
      const RayBatch part = make_batch(std::span(rays_).subspan(first, n));
      const std::vector<Hit> hits = closest_hits(*structure, part);
      const AllHits all = all_hits(*structure, part);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_TRUE(same_bits(hits[i], closest[first + i]));
        ASSERT_TRUE(std::equal(hits_of(all, i).begin(), hits_of(all, i).end(),
                               hits_of(whole, first + i).begin(), hits_of(whole, first + i).end(),
                               [](const Hit& a, const Hit& b) { return same_bits(a, b); }));
      }
      first += n;
    }
  }
}

/// Numbers written one after the other at any distance and alignment, junk between them.
class Packed {
 public:
  Packed(std::size_t count, std::size_t stride, std::size_t lead)
      : bytes_(lead + count * stride + 8, std::byte{0xa5}), stride_(stride), lead_(lead) {}
  template <class T>
  void put(std::size_t i, std::size_t offset, T value) {
    std::memcpy(bytes_.data() + lead_ + i * stride_ + offset, &value, sizeof value);
  }
  const std::byte* data() const { return bytes_.data() + lead_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t stride_, lead_;
};

template <class T>
Packed packed_vectors(const std::vector<Vec3d>& values, std::size_t stride, std::size_t lead) {
  Packed memory(values.size(), stride, lead);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      memory.put(i, static_cast<std::size_t>(axis) * sizeof(T), static_cast<T>(values[i][axis]));
  return memory;
}

template <class Index>
Packed packed_indices(std::size_t triangles, std::size_t stride, std::size_t lead) {
  Packed memory(triangles, stride, lead);
  for (std::size_t i = 0; i < triangles; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      memory.put(i, k * sizeof(Index), static_cast<Index>(3 * i + k));
  return memory;
}

TEST_P(Invariance, OddStridesUnalignedMemoryAndWiderTypesOfTheMeshGiveTheSameBits) {
  const TriangleMesh plain = mesh_of(triangles_);
  std::vector<Vec3d> vertices;
  for (std::size_t i = 0; i < plain.vertices.count; ++i) vertices.push_back(plain.vertices[i]);
  const Packed floats = packed_vectors<float>(vertices, 17, 1);
  const Packed doubles = packed_vectors<double>(vertices, 31, 3);
  const Packed narrow = packed_indices<std::uint32_t>(plain.size(), 13, 5);
  const Packed wide = packed_indices<std::uint64_t>(plain.size(), 29, 7);
  const VertexView views[] = {{floats.data(), vertices.size(), 17, false},
                              {doubles.data(), vertices.size(), 31, true}};
  const IndexView indices[] = {{narrow.data(), plain.size(), 13, false},
                               {wide.data(), plain.size(), 29, true}};
  const auto expected = build_all(scene_of(plain));
  for (const VertexView& view : views)
    for (const IndexView& index : indices) {
      const auto built = build_all(scene_of(TriangleMesh{view, index, nullptr}));
      for (std::size_t s = 0; s < built.size(); ++s) {
        SCOPED_TRACE(built[s]->spec());
        EXPECT_EQ(built[s]->tree_hash(), expected[s]->tree_hash());
        expect_same_hits(all_hits(*built[s], make_batch(rays_)),
                         all_hits(*expected[s], make_batch(rays_)));
      }
    }
}

TEST_P(Invariance, OddStridesUnalignedMemoryAndFloatsOfTheRaysGiveTheSameBits) {
  std::vector<Vec3d> orgs, dirs;
  for (const Ray& ray : rays_) orgs.push_back(ray.org), dirs.push_back(ray.dir);
  Packed limits(rays_.size(), 11, 1);
  for (std::size_t i = 0; i < rays_.size(); ++i) limits.put(i, 0, rays_[i].t_max);
  const Packed float_orgs = packed_vectors<float>(orgs, 15, 3);
  const Packed double_dirs = packed_vectors<double>(dirs, 25, 1);
  const Packed double_orgs = packed_vectors<double>(orgs, 33, 6);
  const Packed float_dirs = packed_vectors<float>(dirs, 12, 2);
  RayBatch batches[2];
  batches[0].org = {float_orgs.data(), rays_.size(), 15, false};
  batches[0].dir = {double_dirs.data(), rays_.size(), 25, true};
  batches[1].org = {double_orgs.data(), rays_.size(), 33, true};
  batches[1].dir = {float_dirs.data(), rays_.size(), 12, false};
  for (const auto& structure : build_all(scene_of(mesh_of(triangles_)))) {
    SCOPED_TRACE(structure->spec());
    for (RayBatch& batch : batches) {
      batch.t_max = ScalarView{limits.data(), 11, true};
      expect_same_hits(all_hits(*structure, batch), all_hits(*structure, make_batch(rays_)));
    }
  }
}

TEST_P(Invariance, AStrideOfZeroRepeatsOneRay) {
  const Ray ray = rays_.front();
  RayBatch batch = make_batch({&ray, 1});
  batch.org.stride = batch.dir.stride = 0, batch.org.count = batch.dir.count = 50;
  batch.t_min->stride = batch.t_max->stride = 0;
  for (const auto& structure : build_all(scene_of(mesh_of(triangles_))))
    for (const Hit& hit : closest_hits(*structure, batch))
      ASSERT_TRUE(same_bits(hit, structure->closest_hit(ray))) << structure->spec();
}

INSTANTIATE_TEST_SUITE_P(Seeds, Invariance, testing::Range(std::uint64_t{1}, kSeeds + 1));

}  // namespace
}  // namespace strahl::test
