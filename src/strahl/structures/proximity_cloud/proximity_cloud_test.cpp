#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/geometry/scene.h>
#include <strahl/query/counters.h>
#include <strahl/query/policies.h>
#include <strahl/structures/grid/grid.h>
#include <strahl/structures/proximity_cloud/proximity_cloud.h>
#include <strahl/traverse/nasty_rays_test.h>

namespace strahl {

/// May spoil what validate() has to notice.
class ProximityCloudTest : public testing::Test {
 protected:
  static std::vector<std::uint32_t>& words(ProximityCloud& cloud) { return cloud.words_; }
  static std::vector<std::uint32_t>& lists(ProximityCloud& cloud) { return cloud.lists_; }
  static const UniformCells& cells(const ProximityCloud& cloud) { return cloud.cells_; }
};

namespace {

using ScenePtr = std::shared_ptr<const Scene>;

constexpr CellMetric kMetrics[] = {CellMetric::chessboard, CellMetric::city_block,
                                   CellMetric::euclid, CellMetric::octant};

/// Small triangles in a box with these sides.
ScenePtr specks(int count, double size, const Vec3d& sides, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 3 * count; ++i) {
    Vec3d v = i % 3 == 0 ? Vec3d{} : vertices[static_cast<std::size_t>(i - i % 3)];
    for (int a = 0; a < 3; ++a)
      v[a] += i % 3 == 0 ? sides[a] * rng.uniform() : size * rng.uniform(-1, 1);
    vertices.push_back(v), indices.push_back(static_cast<std::uint32_t>(i));
  }
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  SceneData data;
  data.geometries.push_back(std::move(geometry));
  return std::make_shared<const Scene>(std::move(data));
}

/// Counters and primitives that write down which lists a ray looks into, in order.
struct Diary : NoCounters {
  std::vector<std::uint32_t> lists;
  std::size_t steps = 0;
  void traversal_step() { ++steps; }
  void leaf_entered(bool is_empty) {
    if (!is_empty) lists.push_back(UINT32_MAX);  // a list begins
  }
};
struct DiaryPrims {
  template <class Q>
  bool visit(std::uint32_t reference, const PreparedRay&, Q&, Diary& diary) {
    diary.lists.push_back(reference);
    return false;
  }
};

template <class Structure>
Diary diary_of(const Structure& structure, const PreparedRay& ray) {
  Diary diary;
  DiaryPrims prims;
  AnyHit query({ray.org, ray.dir, ray.t_min, ray.t_max}, {});
  structure.trace(prims, ray, query, diary);
  return diary;
}

struct Shape {
  Vec3d sides;
  CellPosition n;
  int thin;
};

const Shape kShapes[] = {{{1, 1, 1}, {16, 16, 16}, 8},
                         {{4, 4, 0.3}, {24, 20, 3}, 8},
                         {{4, 4, 0.3}, {24, 20, 3}, 0},
                         {{1, 9, 1}, {3, 50, 7}, 4}};

TEST_F(ProximityCloudTest, LooksIntoTheListsOfTheGridInTheSameOrder) {
  std::uint64_t seed = 0;
  for (const Shape& shape : kShapes)
    for (const int count : {3, 40, 400})
      for (const CellMetric metric : kMetrics) {
        const ScenePtr scene = specks(count, 0.02, shape.sides, ++seed);
        GridOptions plain;
        plain.resolution = GridResolution::fixed, plain.mailbox = false;
        plain.nx = shape.n[0], plain.ny = shape.n[1], plain.nz = shape.n[2];
        ProximityCloudOptions jumping;
        static_cast<CellGridOptions&>(jumping) = plain;
        jumping.mailbox = false, jumping.metric = metric, jumping.thin = shape.thin;
        const Grid grid(*scene, plain, {});
        const ProximityCloud cloud(*scene, jumping, {});
        NastyRays rays(cells(cloud), seed);
        std::size_t steps = 0, jumps = 0;
        for (int i = 0; i < 1500; ++i) {
          const PreparedRay ray = rays.next();
          const Diary expected = diary_of(grid, ray), got = diary_of(cloud, ray);
          ASSERT_EQ(got.lists, expected.lists) << "ray " << i << " seed " << seed;
          ASSERT_LE(got.steps, expected.steps) << "ray " << i << " seed " << seed;
          steps += expected.steps, jumps += got.steps;
        }
        EXPECT_LT(jumps, steps) << "seed " << seed;
      }
}

/// Distance between cells as the words count it, or kFar.
std::uint32_t distance_between(const CellPosition& a, const CellPosition& b, const CellSpace& space,
                               int octant) {
  std::uint32_t sum = 0, largest = 0, squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int difference = b[i] - a[i];
    if (difference != 0 && (space.layers >> i & 1) != 0) return kFar;
    if (octant >= 0 && ((octant >> i & 1) != 0 ? difference > 0 : difference < 0)) return kFar;
    const auto d = static_cast<std::uint32_t>(std::abs(difference));
    sum += d, squares += d * d, largest = std::max(largest, d);
  }
  return space.metric == CellMetric::city_block ? sum
         : space.metric == CellMetric::euclid   ? squares
                                                : largest;
}

void expect_right_distances(const UniformCells& grid, const CellSpace& space,
                            const std::vector<std::uint32_t>& words) {
  std::vector<CellPosition> all, full;
  for (int z = 0; z < grid.n(2); ++z)
    for (int y = 0; y < grid.n(1); ++y)
      for (int x = 0; x < grid.n(0); ++x) {
        all.push_back({x, y, z});
        if (words[grid.index(all.back())] == 0) full.push_back(all.back());
      }
  const auto nearest = [&](const CellPosition& at, int octant) {
    std::uint32_t least = kFar;
    for (const CellPosition& f : full)
      least = std::min(least, distance_between(at, f, space, octant));
    return least;
  };
  for (const CellPosition& at : all) {
    const std::uint32_t word = words[grid.index(at)];
    if (word == 0) continue;
    ASSERT_NE(word & kEmptyCell, 0u);
    const std::uint32_t around = nearest(at, -1);
    if (space.metric != CellMetric::octant) {
      ASSERT_EQ(word & ~kEmptyCell, around);
      continue;
    }
    ASSERT_EQ(word & kNearMask, std::min(around, kNearMask));
    for (unsigned octant = 0; octant < 8; ++octant) {
      const auto told = static_cast<std::uint32_t>(jump_of(word, space, octant).distance);
      const std::uint32_t exact = nearest(at, static_cast<int>(octant));
      const std::uint32_t code = octant_code(word, octant);
      ASSERT_LE(told, exact);
      ASSERT_TRUE(code == 7 || octant_distance(word & kNearMask, code + 1) > exact);
    }
  }
}

TEST_F(ProximityCloudTest, DistancesAreThoseOfTheDefinition) {
  Rng rng(1);
  for (const CellPosition& n : {CellPosition{9, 8, 7}, {1, 40, 3}, {160, 1, 1}, {4, 4, 30}})
    for (const std::uint32_t one_in : {4u, 30u, 300u})
      for (const CellMetric metric : kMetrics)
        for (const unsigned layers : {0u, 1u, 4u}) {
          const UniformCells grid({{0, 0, 0}, {1, 1, 1}}, n);
          std::vector<std::uint32_t> words(grid.count(), 1);
          for (std::uint32_t& word : words) word = rng.below(one_in) != 0;
          words[rng.below(static_cast<std::uint32_t>(words.size()))] = 0;
          fill_distance_words(grid, {metric, layers}, {}, words);
          expect_right_distances(grid, {metric, layers}, words);
        }
}

TEST_F(ProximityCloudTest, ValidateNoticesWrongDistancesAndLists) {
  const ScenePtr scene = specks(30, 0.02, {1, 1, 1}, 2);
  for (const CellMetric metric : kMetrics) {
    ProximityCloudOptions options;
    options.metric = metric, options.density = 60;
    ProximityCloud cloud(*scene, options, {});
    ASSERT_NO_THROW(cloud.validate(*scene));
    const auto refuses = [&](std::uint32_t& word, std::uint32_t wrong) {
      std::swap(word, wrong);
      EXPECT_THROW(cloud.validate(*scene), std::logic_error) << word << " for " << wrong;
      std::swap(word, wrong);
    };
    std::vector<std::uint32_t>& all = words(cloud);
    for (std::size_t c = 0; c < all.size(); c += 7) {
      if ((all[c] & kEmptyCell) == 0) {
        refuses(all[c], all[c] + 1);
        refuses(all[c], kEmptyCell | 1);
        continue;
      }
      refuses(all[c], all[c] + 1);
      refuses(all[c], all[c] - 1);
      refuses(all[c], 0);
      for (unsigned octant = 0; metric == CellMetric::octant && octant < 8; ++octant) {
        const std::uint32_t code = octant_code(all[c], octant), one = 1u << (7 + 3 * octant);
        const std::uint32_t near = all[c] & kNearMask;
        const auto differs = [&](std::uint32_t other) {
          return octant_distance(near, other) != octant_distance(near, code);
        };
        if (code > 0 && differs(code - 1)) refuses(all[c], all[c] - one);
        if (code < 7 && differs(code + 1)) refuses(all[c], all[c] + one);
      }
    }
    refuses(lists(cloud)[0], lists(cloud)[0] + 1);
    refuses(lists(cloud)[1], lists(cloud)[1] + 1);
  }
}

TEST_F(ProximityCloudTest, ShortJumpsAreStepsIfSoWanted) {
  const ScenePtr scene = specks(100, 0.02, {1, 1, 1}, 3);
  Rng rng(4);
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i)
    rays.push_back({{rng.uniform(), rng.uniform(), -1}, {rng.uniform(-0.3, 0.3), 0.1, 1}});
  BatchContext counting;
  counting.count_work = true;
  std::vector<std::uint32_t> counts(rays.size());
  const auto steps = [&](const std::string& spec) {
    return build(scene, spec)
        ->count_hits(make_batch(rays), counts, counting)
        .counters.traversal_steps;
  };
  const auto plain = steps("grid:density=100");
  for (const char* metric : {"chessboard", "city_block", "euclid", "octant"}) {
    const std::string spec = std::string("proximity_cloud:density=100,metric=") + metric;
    EXPECT_LT(steps(spec), steps(spec + ",min_jump=5")) << metric;
    EXPECT_LT(steps(spec + ",min_jump=5"), plain) << metric;
    EXPECT_EQ(steps(spec + ",min_jump=1024"), plain) << metric;
  }
}

TEST_F(ProximityCloudTest, HonoursMemoryLimitAndCancelling) {
  const ScenePtr scene = specks(500, 0.1, {1, 1, 1}, 5);
  for (const CellMetric metric : kMetrics) {
    ProximityCloudOptions options;
    options.metric = metric;
    BuildContext cancelled;
    cancelled.progress = [](double, std::string_view stage) {
      return stage != "measuring distances";
    };
    EXPECT_THROW(ProximityCloud(*scene, options, cancelled), Error);
  }
  const auto needs = [&](const char* spec, std::uint64_t limit) {
    BuildContext tight;
    tight.memory_limit = limit;
    try {
      build(scene, spec, tight);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  std::uint64_t enough = 1000;
  while (needs("grid:density=100", enough)) enough += 1000;
  EXPECT_TRUE(needs("proximity_cloud:density=100", enough));
  EXPECT_FALSE(needs("proximity_cloud:density=100", 2 * enough));
}

TEST_F(ProximityCloudTest, OfNothingHitsNothing) {
  const ScenePtr scene = specks(0, 1, {1, 1, 1}, 6);
  for (const CellMetric metric : kMetrics) {
    ProximityCloudOptions options;
    options.metric = metric, options.resolution = GridResolution::fixed;
    const ProximityCloud cloud(*scene, options, {});
    ASSERT_NO_THROW(cloud.validate(*scene));
    EXPECT_EQ(diary_of(cloud, PreparedRay({{0, 0, 0}, {1, 0, 0}}, {})).steps, 0u);
  }
}

}  // namespace
}  // namespace strahl
