#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <tests/support/wide_breaker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/scene.h>
#include <strahl/structures/wide_bvh/wide_any_order.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_order.h>

namespace strahl {
namespace {

SceneData random_triangles(std::size_t count, double size, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  const auto point = [&](double spread) {
    const double x = rng.uniform(-spread, spread), y = rng.uniform(-spread, spread);
    return Vec3d{x, y, rng.uniform(-spread, spread)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d middle = point(1.0);
    for (int k = 0; k < 3; ++k) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(Vec3f(middle + point(size)));
    }
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return data;
}

WideBvhOptions with(WideQuality quality, WideWidth width = WideWidth::eight) {
  WideBvhOptions options;
  options.quality = quality, options.width = width;
  return options;
}

constexpr WideQuality kQualities[] = {WideQuality::fast, WideQuality::balanced, WideQuality::high};

std::uint64_t hash_of(const WideBvh& bvh) {
  Hash64 hash;
  bvh.hash_into(hash);
  return hash.digest();
}

/// What validate() says of a tree with a planted fault; empty when it says nothing.
std::string verdict(const std::function<void(WideBvhBreaker&)>& plant,
                    const WideBvhOptions& options = with(WideQuality::balanced)) {
  const Scene scene(random_triangles(300, 0.1, 1));
  WideBvh bvh(scene, options, {});
  EXPECT_NO_THROW(bvh.validate(scene));
  WideBvhBreaker breaker(bvh);
  plant(breaker);
  try {
    bvh.validate(scene);
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(WideBvh, ValidateSeesBrokenBoxes) {
  EXPECT_EQ(verdict([](WideBvhBreaker& b) {
              float& side = b.planes(b.tree.root, 3)[b.used_slot(b.tree.root)];
              side = std::nextafter(side, -9.0f);
            }).find("wide_bvh: "),
            0u);
  EXPECT_EQ(verdict([](WideBvhBreaker& b) {
              b.planes(b.tree.root, 0)[b.used_slot(b.tree.root)] = std::nanf("");
            }).find("wide_bvh: "),
            0u);
}

TEST(WideBvh, ValidateSeesAnOrderThatLeavesOutASlot) {
  WideBvhOptions options;
  options.width = WideWidth::sixteen;
  EXPECT_EQ(verdict(
                [](WideBvhBreaker& b) {
                  float* planes = b.planes(b.tree.root, 0);
                  planes[0] = with_ordered_slot(planes[0], ordered_slot(planes[1]));
                },
                options),
            "wide_bvh: the order of any hit leaves out a slot");
}

TEST(WideBvh, ValidateSeesBrokenBlocks) {
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { b.corners(b.block())[0] += 1.0f; }),
            "wide_bvh: a block's corners are not the primitive's");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { b.references(b.block())[0] = 300; }),
            "wide_bvh: a reference is out of range");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) {
              std::uint32_t* references = b.references(b.block());
              std::swap(references[0], references[1]);
            }),
            "wide_bvh: references of a block do not ascend");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { b.bound(b.block()).per_distance *= 0.01f; }),
            "wide_bvh: a block's error bound is too small");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { b.bound(b.block()).constant *= 0.01f; }),
            "wide_bvh: a block's error bound is too small");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { b.bound(b.block()).to_t *= 0.01f; }),
            "wide_bvh: a block's bound of t is too small");
}

TEST(WideBvh, ValidateSeesAWrongReport) {
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { ++b.report.nodes; }), "wide_bvh: report: nodes");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { ++b.report.leaves; }), "wide_bvh: report: nodes");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { --b.report.references; }),
            "wide_bvh: report: references");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { ++b.report.depth; }), "wide_bvh: report: depth");
  EXPECT_EQ(verdict([](WideBvhBreaker& b) { ++b.report.bytes; }), "wide_bvh: report: bytes");
}

TEST(WideBvh, HoldsScenesOfAnySizeAndNone) {
  for (const std::size_t count : {0u, 1u, 2u, 8u, 9u, 40u})
    for (const WideQuality quality : kQualities)
      for (const WideWidth width : {WideWidth::eight, WideWidth::sixteen}) {
        const Scene scene(random_triangles(count, 0.3, 2));
        const WideBvh bvh(scene, with(quality, width), {});
        EXPECT_NO_THROW(bvh.validate(scene)) << count;
        EXPECT_EQ(bvh.report().leaves == 0, count == 0);
      }
}

TEST(WideBvh, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Scene scene(random_triangles(12000, 0.1, 3));
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const WideQuality quality : kQualities) {
    const WideBvh serial(scene, with(quality), {}), parallel(scene, with(quality), two);
    EXPECT_EQ(hash_of(serial), hash_of(parallel));
    EXPECT_EQ(serial.report().sah_cost, parallel.report().sah_cost);
  }
}

TEST(WideBvh, KeepsToTheMemoryLimitAndCanBeCancelled) {
  const Scene scene(random_triangles(5000, 0.1, 4));
  for (const WideQuality quality : kQualities) {
    BuildContext small;
    small.memory_limit = 100'000;
    EXPECT_THROW(WideBvh(scene, with(quality), small), Error);
    for (const std::string stage : {"building", "laying out"}) {
      BuildContext cancelled;
      cancelled.progress = [&](double, std::string_view at) { return at != stage; };
      EXPECT_THROW(WideBvh(scene, with(quality), cancelled), Error) << stage;
    }
  }
}

TEST(WideBvh, TakesAboutFiftySixBytesPerTriangle) {
  const Scene scene(random_triangles(20000, 0.02, 5));
  const WideBvh bvh(scene, with(WideQuality::balanced), {});
  EXPECT_LT(static_cast<double>(bvh.report().bytes) / 20000, 58.0);
}

/// Small triangles everywhere, and a few long ones that spatial splits cut.
SceneData mixed_triangles() {
  SceneData data = random_triangles(40000, 0.01, 7);
  data.geometries.push_back(random_triangles(200, 0.3, 8).geometries[0]);
  data.geometries.back().geometry_id = 1;
  return data;
}

TEST(WideBvh, TheDefaultCutsLongTrianglesAsFarAsMemoryAllows) {
  const Scene scene(mixed_triangles());
  for (const WideLayout layout : {WideLayout::full, WideLayout::compact})
    for (const WideWidth width : {WideWidth::eight, WideWidth::sixteen}) {
      WideBvhOptions options = with(WideQuality::balanced, width);
      options.layout = layout;
      const WideBvh bvh(scene, options, {});
      EXPECT_NO_THROW(bvh.validate(scene));
      const double growth = static_cast<double>(bvh.report().references) / scene.size();
      if (layout == WideLayout::compact && width == WideWidth::eight)
        EXPECT_EQ(growth, 1.0);
      else
        EXPECT_TRUE(growth > 1.01 && growth <= 1.12) << growth;
    }
}

TEST(WideBvh, KnowsItsSizeBeforeItIsBuilt) {
  const Scene large(mixed_triangles()), small(random_triangles(500, 0.1, 9));
  for (const WideQuality quality : kQualities)
    for (const auto& [width, layout] : {std::pair(WideWidth::eight, WideLayout::full),
                                        std::pair(WideWidth::sixteen, WideLayout::full),
                                        std::pair(WideWidth::sixteen, WideLayout::compact)}) {
      const auto ratio = [&, width = width, layout = layout](const Scene& scene) {
        WideBvhOptions options = with(quality, width);
        options.layout = layout;
        const auto bytes = static_cast<double>(WideBvh(scene, options, {}).report().bytes);
        return static_cast<double>(WideBvh::estimate_bytes(scene, options, {})) / bytes;
      };
      EXPECT_EQ(ratio(small), 1.0);
      EXPECT_NEAR(ratio(large), 1.0, 0.1);
    }
}

TEST(WideOrder, PutsTheBitsOfSlotsIntoARaysOrder) {
  for (std::uint32_t order = 0; order < 8; ++order)
    for (std::uint32_t bits = 1; bits < 256; ++bits) {
      const std::uint32_t ordered = visiting_order<8>(bits, order);
      const std::uint64_t slots = wide_slots(bits, order);
      const int count = __builtin_popcount(bits);
      int listed = 0;
      for (std::uint32_t p = 8; p-- > 0;) {
        const bool is_hit = (bits >> (p ^ order) & 1u) != 0;
        ASSERT_EQ((ordered >> p & 1u) != 0, is_hit);
        if (is_hit) {
          ASSERT_EQ(slots >> (8 * listed++) & 7u, p ^ order);
        }
      }
      ASSERT_EQ(slots >> 56, slots >> (8 * (count - 1)) & 255u);
    }
  for (std::uint32_t order = 0; order < 16; order += 2)
    for (std::uint32_t slot = 0; slot < 16; ++slot)
      ASSERT_EQ(visiting_order<16>(1u << slot, order), 1u << (slot ^ order));
}

TEST(WideOrder, FillsTheSlotsOfTheCorners) {
  std::vector<Vec3d> centers;
  for (int i = 0; i < 8; ++i)
    centers.push_back({i & 1 ? 1. : 0., i & 2 ? 1. : 0., i & 4 ? 1. : 0.});
  int slots[8];
  assign_slots(centers, {0.5, 0.5, 0.5}, 8, slots);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(slots[i], i);
  int wide[16];
  assign_slots(centers, {0.5, 0.5, 0.5}, 16, wide);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(wide[i] / 2, i);
}

TEST(WideOrder, NoExchangeOfTwoSlotsFitsBetter) {
  const auto fit = [](const Vec3d& c, int slot) {
    return (slot & 1 ? c.x : -c.x) + (slot & 2 ? c.y : -c.y) + (slot & 4 ? c.z : -c.z);
  };
  Rng rng(7);
  const auto draw = [&] { return rng.next_u32() * 0x1p-31 - 1; };
  for (int node = 0; node < 200; ++node) {
    std::vector<Vec3d> c(8);
    for (Vec3d& center : c) center = {draw(), draw(), draw()};
    int slots[8];
    assign_slots(c, {0, 0, 0}, 8, slots);
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < a; ++b) {
        ASSERT_NE(slots[a], slots[b]);
        ASSERT_GT(fit(c[a], slots[a]) + fit(c[b], slots[b]) + 1e-4,
                  fit(c[a], slots[b]) + fit(c[b], slots[a]));
      }
  }
}

TEST(WideFrame, KeepsSuitedScenesAndMovesOthers) {
  EXPECT_TRUE(make_wide_frame({{-1, -1, -1}, {1, 2, 1}}).is_identity());
  for (const Aabb& box :
       {Aabb{{1e6, 1e6, 1e6}, {1e6 + 1, 1e6 + 2, 1e6 + 1}}, Aabb{{-1e-30, 0, 0}, {1e-30, 1e-30, 0}},
        Aabb{{-1e50, 0, 0}, {1e60, 1, 1}}, Aabb{{5, 5, 5}, {5, 5, 5}}}) {
    const WideFrame frame = make_wide_frame(box);
    EXPECT_FALSE(frame.is_identity());
    EXPECT_LE(norm_max(frame.to_frame(box.lo)), frame.reach);
    EXPECT_LE(norm_max(frame.to_frame(box.hi)), frame.reach);
  }
}

/// A ray in a frame must lie where the ray lies, its planes on the safe sides.
TEST(WideRay, BoundsWhereItMeetsPlanes) {
  Rng rng(6);
  const WideFrame frame = make_wide_frame({{-3, -3, -3}, {3, 3, 3}});
  for (int i = 0; i < 20000; ++i) {
    const double far = std::ldexp(1.0, static_cast<int>(rng.below(40)) - 4);
    Ray ray;
    for (int a = 0; a < 3; ++a) {
      ray.dir[a] = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(8)) * -10);
      ray.org[a] = rng.uniform(-3, 3) - (i % 3 == 0 ? 0.0 : far * ray.dir[a]);
    }
    const WideRay wide(ray, 0.0, frame);
    for (int a = 0; a < 3; ++a) {
      if (std::abs(ray.dir[a]) < 1e-12) continue;
      const auto plane = static_cast<float>(rng.uniform(-3, 3));
      const long double exact =
          (static_cast<long double>(plane) - ray.org[a]) / ray.dir[a] * wide.per_t - wide.start;
      const auto near = static_cast<long double>(std::fma(plane, wide.rcp[a], wide.near[a]));
      const auto last = static_cast<long double>(std::fma(plane, wide.rcp[a], wide.far[a]));
      // Long doubles round t * per_t - start, too: allow for what they lose.
      const long double slack = 1e-18L * (std::abs(exact) + wide.start);
      ASSERT_LE(near, exact + slack) << i << ' ' << a;
      ASSERT_GE(last, exact - slack) << i << ' ' << a;
    }
  }
}

}  // namespace
}  // namespace strahl
