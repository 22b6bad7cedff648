// What kernels decide of lanes that floats leave open, against exact arithmetic for every edge.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/edge_signs.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

struct Triangles final : PrimitiveSource {
  std::vector<TriangleVertices> all;

  std::uint32_t size() const override { return static_cast<std::uint32_t>(all.size()); }
  Aabb bounds(std::uint32_t i) const override { return all[i].bounds(); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(bounds(i), box);
  }
  bool triangle(std::uint32_t i, TriangleVertices& out) const override {
    out = all[i];
    return true;
  }
};

/// A ray and the triangles of a block, all of floats.
struct Case {
  Vec3d org, dir;
  std::vector<TriangleVertices> triangles;
};

/// A tree that is nothing but a block.
struct BlockTree {
  static constexpr std::size_t kBytes = 2048;
  WideTree tree;

  BlockTree(const std::vector<TriangleVertices>& triangles, int width, WideLayout layout) {
    Triangles source;
    source.all = triangles;
    std::vector<std::uint32_t> references(triangles.size());
    for (std::uint32_t i = 0; i < references.size(); ++i) references[i] = i;
    tree.arena = WideArena(kBytes);
    tree.width = width, tree.layout = layout, tree.has_exact_corners = true;
    tree.root = kWideLeaf | static_cast<WideId>(triangles.size() - 1);
    const std::size_t bytes = block_sizes(references, tree, source).bytes(9);
    EXPECT_LE(bytes + kWideSlack, kBytes);
    EXPECT_TRUE(write_block(tree.arena.data(), references, tree, source, bytes).fits);
  }
};

WideRays rays_of(const Case& c, std::uint32_t i) {
  WideRays rays;
  for (int a = 0; a < 3; ++a) {
    rays.org[a][i] = static_cast<float>(c.org[a]);
    rays.given[a][i] = static_cast<float>(c.dir[a]);
  }
  return rays;
}

/// 1 or -1 where the ray crosses the triangle.
int side(const Case& c, const TriangleVertices& t) {
  const int ab = exact_edge_sign(c.org, c.dir, t.a, t.b);
  const int bc = exact_edge_sign(c.org, c.dir, t.b, t.c);
  const int ca = exact_edge_sign(c.org, c.dir, t.c, t.a);
  return ab == bc && bc == ca ? ab : 0;
}

/// How many lanes were asked for, and left to others.
struct Tally {
  int asked = 0, left = 0;
};

void check(const Case& c, const WideKernel& kernel, const WideTree& tree, std::uint32_t lanes,
           Tally& tally) {
  const std::uint32_t ray = lanes % kWideBlock;
  const WideDecision got =
      kernel.decide[tree.width == 16](tree, rays_of(c, ray), ray, tree.root, lanes);
  ASSERT_EQ((got.crossed | got.left) & ~lanes, 0u);
  ASSERT_EQ(got.crossed & got.left, 0u);
  ASSERT_EQ(got.fronts & ~got.crossed, 0u);
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    ++tally.asked;
    if ((got.left >> lane & 1u) != 0) {
      ++tally.left;
      continue;
    }
    const int expected = side(c, c.triangles[lane]);
    ASSERT_EQ(got.crossed >> lane & 1u, expected != 0) << "lane " << lane;
    ASSERT_EQ(got.fronts >> lane & 1u, expected < 0) << "lane " << lane;
  }
}

/// Both widths and layouts, all lanes and some.
Tally check_all(const std::function<Case(Rng&)>& make, int count, const WideKernel& kernel) {
  Tally tally;
  Rng rng(7);
  for (int i = 0; i < count; ++i) {
    const Case c = make(rng);
    const auto size = static_cast<std::uint32_t>(c.triangles.size());
    for (const int width : {8, 16}) {
      if (size > static_cast<std::uint32_t>(width)) continue;
      for (const WideLayout layout : {WideLayout::full, WideLayout::compact}) {
        const BlockTree block(c.triangles, width, layout);
        if (!block.tree.is_exact(block.tree.at(block.tree.root))) continue;
        const std::uint32_t all = (2u << (size - 1)) - 1, some = rng.below(all) + 1;
        for (const std::uint32_t lanes : {all, some}) check(c, kernel, block.tree, lanes, tally);
      }
    }
    if (testing::Test::HasFatalFailure()) break;
  }
  return tally;
}

Vec3d rounded(const Vec3d& v) { return Vec3d(Vec3f(v)); }
Vec3d point(Rng& rng, double size) {
  const double x = rng.uniform(-size, size), y = rng.uniform(-size, size);
  return rounded({x, y, rng.uniform(-size, size)});
}
Vec3d lattice_point(Rng& rng, std::uint32_t n) {
  const auto one = [&] { return static_cast<double>(rng.below(2 * n + 1)) - n; };
  const double x = one(), y = one();
  return {x, y, one()};
}

/// A ray from one of few points through another: corners, edges and planes are met exactly.
Case lattice_case(Rng& rng) {
  Case c;
  c.org = lattice_point(rng, 3);
  do c.dir = lattice_point(rng, 3);
  while (c.dir == Vec3d{});
  for (std::uint32_t n = 1 + rng.below(16); n > 0; --n)
    c.triangles.push_back({lattice_point(rng, 3), lattice_point(rng, 3), lattice_point(rng, 3)});
  return c;
}

/// Through the hub of an umbrella of triangles in general position, exactly: org is a multiple of
/// 2^-20, as is the hub.
Case hub_case(Rng& rng) {
  const auto snapped = [](const Vec3d& v) {
    return Vec3d{std::round(v.x * 0x1p20), std::round(v.y * 0x1p20), std::round(v.z * 0x1p20)} *
           0x1p-20;
  };
  Case c;
  const Vec3d hub = snapped(point(rng, 1));
  c.org = snapped(point(rng, 1) + Vec3d{0, 0, 5});
  c.dir = rounded(hub - c.org);
  const std::uint32_t n = 3 + rng.below(10);
  std::vector<Vec3d> rim;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n;
    rim.push_back(
        rounded(hub + 0.1 * Vec3d{std::cos(angle), std::sin(angle), 0} + point(rng, 0.01)));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3d corners[] = {hub, rim[i], rim[(i + 1) % n]};
    const std::uint32_t first = rng.below(3);
    c.triangles.push_back({corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]});
  }
  return c;
}

/// The ray seems to pass exactly through a corner that lies beside it by less than corner - org
/// tells as a double, because one of them is tiny, or by less than rounded products tell.
Case beside_case(Rng& rng) {
  Case c;
  c.dir = point(rng, 1);
  Vec3d on = rounded(4.0 * c.dir);
  switch (rng.below(4)) {
    case 0:
      on = point(rng, 0x1p-43), c.org = rounded(-1024.0 * c.dir);
      break;
    case 1:
      c.org = point(rng, 0x1p-60);
      break;
    case 2:
      c.org = lattice_point(rng, 1) * 0x1p-51;
      break;
    default:
      c.org = {};
      break;  // it does
  }
  for (int i = 0; i < 6; ++i) c.triangles.push_back({on, point(rng, 5), point(rng, 5)});
  for (TriangleVertices& t : c.triangles) {
    if (rng.below(2) != 0) std::swap(t.a, t.b);
    if (rng.below(2) != 0) std::swap(t.b, t.c);
  }
  return c;
}

class WideDecide : public testing::TestWithParam<const WideKernel*> {
 protected:
  const WideKernel& kernel() const { return *GetParam(); }
};

TEST_P(WideDecide, IsExactOnIntegerCoincidences) { check_all(lattice_case, 3000, kernel()); }

TEST_P(WideDecide, IsNotDeceivedByCornersBesideTheRay) { check_all(beside_case, 3000, kernel()); }

TEST_P(WideDecide, LeavesNothingOfRaysThroughVertices) {
  const Tally tally = check_all(hub_case, 1000, kernel());
  EXPECT_GT(tally.asked, 10000);
  EXPECT_EQ(tally.left, 0);
}

/// Edges along an axis: the first component of the normal is 0.
TEST_P(WideDecide, LeavesNothingAtEdgesAlongAnAxis) {
  const Tally tally = check_all(
      [](Rng& rng) {
        Case c;
        c.org = {1.0 + rng.below(5), -3.0 - rng.below(9), 2.0 + rng.below(7)};
        const Vec3d hub{0, 0, 0}, rim[] = {{8, 0, 0}, {0, 8, 0}, {-8, 0, 0}, {0, -8, 0}};
        c.dir = hub - c.org;
        for (std::size_t i = 0; i < 4; ++i) c.triangles.push_back({hub, rim[i], rim[(i + 1) % 4]});
        return c;
      },
      100, kernel());
  EXPECT_GT(tally.asked, 1000);
  EXPECT_EQ(tally.left, 0);
}

INSTANTIATE_TEST_SUITE_P(All, WideDecide,
                         testing::ValuesIn(wide_kernels().begin(), wide_kernels().end()),
                         [](const auto& given) { return std::string(given.param->isa); });

}  // namespace
}  // namespace strahl
