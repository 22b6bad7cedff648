// Compact blocks: what they hold of all kinds of things, that validate() sees broken ones, and that
// they follow their things.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <tests/support/wide_breaker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

/// Triangles by their corners; without any a box that is no triangle.
struct Things final : PrimitiveSource {
  std::vector<TriangleVertices> triangles;
  std::vector<bool> is_triangle;

  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c, bool is_one = true) {
    triangles.push_back({a, b, c}), is_triangle.push_back(is_one);
  }
  std::uint32_t size() const override { return static_cast<std::uint32_t>(triangles.size()); }
  Aabb bounds(std::uint32_t i) const override {
    Aabb box;
    for (const Vec3d& v : {triangles[i].a, triangles[i].b, triangles[i].c}) box.extend(v);
    return box;
  }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(bounds(i), box);
  }
  bool triangle(std::uint32_t i, TriangleVertices& out) const override {
    if (is_triangle[i]) out = triangles[i];
    return is_triangle[i];
  }
};

/// Triangles around a corner that all share, or each with corners of its own `off` from the others.
Things fan(std::uint32_t count, double off = 0.0) {
  Things things;
  Rng rng(3);
  const auto corner = [&](double angle, double radius) {
    const double x = radius * std::cos(angle) + off * rng.uniform(-1, 1);
    const double y = radius * std::sin(angle) + off * rng.uniform(-1, 1);
    return Vec3d(Vec3f(Vec3d{x, y, 0.0 + off * rng.uniform(-1, 1)}));  // no -0
  };
  for (std::uint32_t i = 0; i < count; ++i)
    things.add(corner(0, 0), corner(0.3 * i, 1), corner(0.3 * (i + 1), 1));
  return things;
}

WideTree compact_tree(const Things& things) {
  WideTree tree;
  tree.layout = WideLayout::compact;
  Aabb box;
  for (std::uint32_t i = 0; i < things.size(); ++i) box.extend(things.bounds(i));
  tree.frame = make_wide_frame(box);
  return tree;
}

/// A block of all things, written with room to spare.
struct Block {
  alignas(16) std::array<std::byte, 1024> bytes{};
  std::uint32_t lanes;

  Block(const Things& things, std::uint64_t spare) : lanes(things.size()) {
    std::vector<std::uint32_t> references;
    for (std::uint32_t i = 0; i < lanes; ++i) references.push_back(i);
    const WideTree tree = compact_tree(things);
    const std::size_t size = block_sizes(references, tree, things).bytes(spare);
    EXPECT_TRUE(write_block(bytes.data(), references, tree, things, size).fits);
    EXPECT_EQ(compact_bytes(bytes.data(), lanes), size);
  }
  const std::byte* at() const { return bytes.data(); }
  TriangleVertices corners(std::uint32_t lane) const { return compact_corners(at(), lanes, lane); }
};

TEST(WideCompactBlock, HoldsACornerOnceThatAllShare) {
  const Things things = fan(16);
  const Block block(things, 0);
  EXPECT_FALSE(is_rounded(block.at()));
  EXPECT_EQ(distinct_of(block.at()), 18u);
  for (std::uint32_t i = 0; i < 16; ++i) {
    EXPECT_EQ(block.corners(i).a, things.triangles[i].a);
    EXPECT_EQ(block.corners(i).b, things.triangles[i].b);
    EXPECT_EQ(block.corners(i).c, things.triangles[i].c);
  }
}

TEST(WideCompactBlock, TellsZerosOfBothSignsApart) {
  Things things;
  things.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  things.add({-0.0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const Block block(things, 2);
  EXPECT_EQ(distinct_of(block.at()), 4u);
  EXPECT_FALSE(std::signbit(block.corners(0).a.x));
  EXPECT_TRUE(std::signbit(block.corners(1).a.x));
}

TEST(WideCompactBlock, RoundsThirtyThreeCornersWhateverMayBeSpared) {
  EXPECT_FALSE(is_rounded(Block(fan(10, 0.1), 18).at()));  // 30 corners
  EXPECT_TRUE(is_rounded(Block(fan(11, 0.1), 18).at()));
  EXPECT_TRUE(is_rounded(Block(fan(10, 0.1), 0).at()));
}

TEST(WideCompactBlock, RoundsByLessThanOneStepInSixtyThousand) {
  const Things things = fan(16, 0.1);
  const Block block(things, 0);
  ASSERT_TRUE(is_rounded(block.at()));
  const double step = static_cast<double>(rounded_head(block.at()).step());
  EXPECT_LE(step, 2 * 2.4 / 65534);
  double largest = 0.0;
  for (std::uint32_t i = 0; i < 16; ++i)
    largest = std::max(largest, length(block.corners(i).b - things.triangles[i].b));
  EXPECT_LE(largest, kCompactError * step);
  EXPECT_GT(largest, 0.1 * step);
}

TEST(WideCompactBlock, HasNoCornersWhereNothingIsATriangle) {
  Things mixed = fan(3), boxes = fan(3), rounded = fan(16, 0.1);
  mixed.is_triangle[1] = false;
  const Block some(mixed, 2);
  EXPECT_FALSE(std::isnan(some.corners(0).a.x));
  EXPECT_TRUE(std::isnan(some.corners(1).a.x));
  boxes.is_triangle.assign(3, false);
  const Block none(boxes, 0);
  EXPECT_EQ(distinct_of(none.at()), 1u);
  EXPECT_TRUE(std::isnan(none.corners(2).c.z));
  rounded.is_triangle[5] = false;
  const Block all(rounded, 0);
  ASSERT_TRUE(is_rounded(all.at()));
  for (std::uint32_t i = 0; i < 16; ++i) EXPECT_TRUE(std::isnan(all.corners(i).b.y));
}

/// Triangles strewn over a cube.
Things strewn(std::size_t count) {
  Rng rng(1);
  Things things;
  const auto vector = [&](double most) {
    const double x = rng.uniform(-most, most), y = rng.uniform(-most, most);
    return Vec3d{x, y, rng.uniform(-most, most)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d middle = vector(1.0);
    const auto corner = [&] { return Vec3d(Vec3f(middle + vector(0.05))); };
    const Vec3d a = corner(), b = corner();
    things.add(a, b, corner());
  }
  return things;
}

/// At least so many triangles of a sheet.
Things sheet(std::size_t count) {
  Things things;
  const auto corner = [](std::size_t i, std::size_t j) {
    const double x = 0.1 * static_cast<double>(i), y = 0.1 * static_cast<double>(j);
    return Vec3d(Vec3f(Vec3d{x, y, 0.1 * std::sin(5 * x) * std::cos(3 * y)}));
  };
  for (std::size_t i = 0; 2 * i * i < count; ++i)
    for (std::size_t j = 0; 2 * j * j < count; ++j) {
      things.add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
      things.add(corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1));
    }
  return things;
}

WideBvhOptions compact(WideWidth width = WideWidth::sixteen) {
  WideBvhOptions options;
  options.layout = WideLayout::compact, options.width = width, options.rebuild_factor = 1000;
  return options;
}

TEST(WideCompactBlock, ValidTreesOfAllSizes) {
  for (const std::size_t count : {1u, 2u, 9u, 17u, 700u})
    for (const bool share : {false, true})
      for (const WideWidth width : {WideWidth::eight, WideWidth::sixteen}) {
        const Things things = share ? sheet(count) : strewn(count);
        const WideBvh bvh(things, compact(width), {});
        EXPECT_NO_THROW(bvh.validate(things)) << count;
      }
}

/// A block of at least two lanes, rounded or not.
std::byte* find_block(WideTree& tree, WideId id, bool rounded, std::uint32_t& lanes) {
  std::byte* at = const_cast<std::byte*>(tree.at(id));
  if (is_leaf(id)) {
    lanes = lanes_of(id);
    return lanes >= 2 && is_rounded(at) == rounded ? at : nullptr;
  }
  for (int slot = 0; slot < tree.width; ++slot) {
    if (!(plane_row(at, tree.width, 0)[slot] <= plane_row(at, tree.width, 3)[slot])) continue;
    std::byte* found = find_block(tree, child_row(at, tree.width)[slot], rounded, lanes);
    if (found != nullptr) return found;
  }
  return nullptr;
}

/// What validate() says of a tree with a planted fault; empty when it says nothing.
std::string verdict(bool rounded, const std::function<void(std::byte*, std::uint32_t)>& plant) {
  const Things things = rounded ? strewn(300) : sheet(300);
  WideBvh bvh(things, compact(), {});
  EXPECT_NO_THROW(bvh.validate(things));
  WideTree& tree = WideBvhBreaker(bvh).tree;
  std::uint32_t lanes = 0;
  std::byte* block = find_block(tree, tree.root, rounded, lanes);
  if (block == nullptr) return "no such block";
  plant(block, lanes);
  try {
    bvh.validate(things);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

RoundedHead& head(std::byte* block) { return *reinterpret_cast<RoundedHead*>(block); }

TEST(WideCompactBlock, ValidateSeesBrokenIndexedBlocks) {
  EXPECT_EQ(verdict(false,
                    [](std::byte* block, std::uint32_t lanes) {
                      const_cast<float&>(distinct_row(block, lanes, 0)[1]) += 1e-5f;
                    }),
            "wide_bvh: a block's corners are not the primitive's");
  EXPECT_EQ(verdict(false,
                    [](std::byte* block, std::uint32_t lanes) {
                      const_cast<std::uint8_t&>(index_row(block, lanes, 1)[0]) = 200;
                    }),
            "wide_bvh: a corner's index is out of range");
  EXPECT_EQ(
      verdict(false, [](std::byte* block,
                        std::uint32_t) { reinterpret_cast<LeafBound*>(block)->constant *= 0.01f; }),
      "wide_bvh: a block's error bound is too small");
  EXPECT_EQ(verdict(false, [](std::byte* block, std::uint32_t) { head(block).word = 33u << 8; }),
            "wide_bvh: a block has too many corners");
}

TEST(WideCompactBlock, ValidateSeesBrokenRoundedBlocks) {
  EXPECT_EQ(verdict(true,
                    [](std::byte* block, std::uint32_t lanes) {
                      const_cast<std::uint16_t&>(rounded_row(block, lanes, 3)[1]) += 2;
                    }),
            "wide_bvh: a block's corners are not the primitive's");
  EXPECT_EQ(verdict(true, [](std::byte* block, std::uint32_t) { head(block).word += 1; }),
            "wide_bvh: a block's corners are not the primitive's");
  EXPECT_EQ(verdict(true,
                    [](std::byte* block, std::uint32_t) {
                      const float less = 0.7f * head(block).longest();
                      head(block).word = (std::bit_cast<std::uint32_t>(less) & ~0xffu) |
                                         (head(block).word & 0xffu);
                    }),
            "wide_bvh: a block's error bound is too small");
  EXPECT_EQ(
      verdict(true, [](std::byte* block, std::uint32_t) { head(block).word = 0; }).substr(0, 10),
      "wide_bvh: ");
}

/// All corners moved, those that were one staying one.
Things shaken(const Things& from) {
  Things to = from;
  for (TriangleVertices& t : to.triangles)
    for (Vec3d* v : {&t.a, &t.b, &t.c})
      *v = Vec3d(Vec3f(*v + 0.01 * Vec3d{std::sin(9 * v->y), std::sin(7 * v->z), v->x * v->x}));
  return to;
}

TEST(WideCompactBlock, FollowsThingsInPlace) {
  for (const bool share : {false, true}) {
    const Things before = share ? sheet(1000) : strewn(1000), after = shaken(before);
    WideBvh bvh(before, compact(), {});
    bvh.refit(after, {});
    EXPECT_EQ(bvh.refits(), 1u);
    EXPECT_NO_THROW(bvh.validate(after));
    bvh.refit(before, {});
    EXPECT_EQ(bvh.refits(), 2u);
    EXPECT_NO_THROW(bvh.validate(before));
  }
}

TEST(WideCompactBlock, IsBuiltAnewWhereCornersComeApart) {
  const Things before = fan(16);
  Things after = fan(16, 0.01);
  WideBvh bvh(before, compact(), {});
  bvh.refit(after, {});
  EXPECT_EQ(bvh.refits(), 0u);
  EXPECT_NO_THROW(bvh.validate(after));
  bvh.refit(before, {});  // corners that come together leave room
  EXPECT_EQ(bvh.refits(), 1u);
  EXPECT_NO_THROW(bvh.validate(before));
}

}  // namespace
}  // namespace strahl
