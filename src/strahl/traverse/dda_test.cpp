#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/traverse/dda.h>
#include <strahl/traverse/nasty_rays_test.h>

namespace strahl {
namespace {

/// The cells of a traversal in order, by index. Checks what holds for every traversal.
std::vector<std::size_t> visited(const UniformCells& cells, const PreparedRay& ray) {
  std::vector<std::size_t> order;
  std::vector<bool> seen(cells.count(), false);
  double t = 0.0;
  dda(cells, ray, [&](const CellVisit& cell) {
    EXPECT_EQ(cell.index, cells.index(cell.at));
    EXPECT_LE(t, cell.t_enter) << "t_enter decreases";
    t = cell.t_enter;
    EXPECT_FALSE(seen[cell.index]) << "visited twice";
    seen[cell.index] = true;
    order.push_back(cell.index);
    return 1;
  });
  return order;
}

template <class Visit>
void for_cells(const UniformCells& cells, Visit visit) {
  for (int z = 0; z < cells.n(2); ++z)
    for (int y = 0; y < cells.n(1); ++y)
      for (int x = 0; x < cells.n(0); ++x) visit(CellPosition{x, y, z});
}

/// Whether the ray's interval meets the cell, planes taken earlier and later by the margin.
bool meets(const UniformCells& cells, const PreparedRay& ray, const CellPosition& at,
           double margin) {
  double enter = ray.t_enter, leave = ray.t_exit;
  for (int a = 0; a < 3; ++a) {
    const int i = at[static_cast<std::size_t>(a)];
    const double first = ray.plane_first(a, cells.plane(a, i + ray.negative[a]));
    const double last = ray.plane_last(a, cells.plane(a, i + !ray.negative[a]));
    if (lowered(first, margin) > enter) enter = lowered(first, margin);
    if (raised(last, margin) < leave) leave = raised(last, margin);
  }
  return enter <= leave;
}

TEST(Dda, VisitsEveryCellThatTheRayMayTouchOnceAndInOrder) {
  for (const UniformCells& cells : grids()) {
    NastyRays rays(cells, 3);
    for (int i = 0; i < 8000; ++i) {
      const PreparedRay ray = rays.next();
      const std::vector<std::size_t> order = visited(cells, ray);
      std::vector<bool> is_visited(cells.count(), false);
      for (const std::size_t c : order) is_visited[c] = true;
      for_cells(cells, [&](const CellPosition& at) {
        const bool is_here = is_visited[cells.index(at)];
        // Parameters of planes are off by a quarter of the margin at most.
        const bool must = meets(cells, ray, at, kPlaneMargin / 2);
        const bool may = meets(cells, ray, at, 2 * kPlaneMargin);
        ASSERT_TRUE(is_here || !must) << "ray " << i << " misses cell " << cells.index(at);
        ASSERT_TRUE(may || !is_here) << "ray " << i << " has no business in " << cells.index(at);
      });
    }
  }
}

/// Exact: org and dir whole numbers, unit cells from 0. Parameters are quotients of whole numbers.
bool touches_exactly(const std::array<int, 3>& org, const std::array<int, 3>& dir,
                     const CellPosition& at) {
  long enter = 0, enter_by = 1, leave = 1, leave_by = 0;  // 0 and infinity
  for (std::size_t a = 0; a < 3; ++a) {
    if (dir[a] == 0) {
      if (org[a] < at[a] || org[a] > at[a] + 1) return false;
      continue;
    }
    const long by = std::abs(dir[a]), sign = dir[a] < 0 ? -1 : 1;
    const long first = sign * (at[a] + (dir[a] < 0) - org[a]);
    const long last = sign * (at[a] + (dir[a] > 0) - org[a]);
    if (first * enter_by > enter * by) enter = first, enter_by = by;
    if (last * leave_by < leave * by) leave = last, leave_by = by;
  }
  return enter * leave_by <= leave * enter_by;
}

TEST(Dda, VisitsAllCellsAroundCornersEdgesAndInPlanesOfALattice) {
  constexpr int n = 6;
  const UniformCells cells({{0, 0, 0}, {n, n, n}}, {n, n, n});
  for (int a = 0; a <= n; ++a) ASSERT_NEAR(cells.plane(0, a), a, 1e-14);
  Rng rng(4);
  for (int i = 0; i < 4000; ++i) {
    std::array<int, 3> org, dir;
    for (std::size_t a = 0; a < 3; ++a) {
      org[a] = static_cast<int>(rng.below(n + 5)) - 2;
      dir[a] = static_cast<int>(rng.below(7)) - 3;
    }
    if (dir == std::array<int, 3>{0, 0, 0}) continue;
    // Planes are a few units in the last place off the whole numbers: widening covers that.
    const PreparedRay ray(
        {Vec3d(Vec3<int>{org[0], org[1], org[2]}), Vec3d(Vec3<int>{dir[0], dir[1], dir[2]})},
        {{{}, {}}, 1e-13, 0.0});
    const std::vector<std::size_t> order = visited(cells, ray);
    std::size_t expected = 0;
    for_cells(cells, [&](const CellPosition& at) {
      if (!touches_exactly(org, dir, at)) return;
      ++expected;
      ASSERT_EQ(std::count(order.begin(), order.end(), cells.index(at)), 1)
          << "ray " << i << " cell " << at[0] << ' ' << at[1] << ' ' << at[2];
    });
    ASSERT_EQ(order.size(), expected) << "ray " << i;
  }
}

TEST(Dda, PassesOneCellAtATimeAwayFromEdges) {
  const UniformCells cells({{0, 0, 0}, {4, 4, 4}}, {4, 4, 4});
  const PreparedRay ray({{-1, 0.3, 0.4}, {1, 0.2, 0.1}}, {});
  std::vector<CellPosition> order;
  dda(cells, ray, [&](const CellVisit& cell) {
    order.push_back(cell.at);
    return 1;
  });
  EXPECT_EQ(order,
            (std::vector<CellPosition>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {3, 1, 0}}));
}

TEST(Dda, EndsWhenTheActionSaysSo) {
  const UniformCells cells({{0, 0, 0}, {4, 4, 4}}, {4, 4, 4});
  const PreparedRay along({{-1, 0.5, 0.5}, {1, 0, 0}}, {});
  int calls = 0;
  EXPECT_TRUE(dda(cells, along, [&](const CellVisit& cell) { return ++calls, cell.at[0] != 2; }));
  EXPECT_EQ(calls, 3);
  const PreparedRay on_an_edge({{-1, 2, 2}, {1, 0, 0}}, {});
  calls = 0;
  EXPECT_TRUE(dda(cells, on_an_edge, [&](const CellVisit&) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(dda(cells, along, [](const CellVisit&) { return 1; }));
}

/// How far cell b is from a as a jump counts it; nothing where it does not count at all.
std::int64_t distance_between(const CellPosition& a, const CellPosition& b, const CellJump& kind,
                              const PreparedRay& ray) {
  constexpr std::int64_t kInfinite = 1000000;
  std::int64_t sum = 0, largest = 0, squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t d = b[i] - a[i];
    if (d != 0 && (kind.layers >> i & 1) != 0) return kInfinite;
    if (kind.metric == CellMetric::octant && (ray.negative[i] ? d > 0 : d < 0)) return kInfinite;
    sum += std::abs(d), squares += d * d, largest = std::max(largest, std::abs(d));
  }
  return kind.metric == CellMetric::city_block ? sum
         : kind.metric == CellMetric::euclid   ? squares
                                               : largest;
}

/// A grid of which some cells matter.
struct Sparse {
  UniformCells cells;
  std::vector<bool> matters;
  std::vector<CellPosition> full;

  Sparse(const UniformCells& grid, std::uint32_t one_in, std::uint64_t seed) : cells(grid) {
    Rng rng(seed);
    for_cells(cells, [&](const CellPosition& at) {
      matters.push_back(rng.below(one_in) == 0);
      if (matters.back()) full.push_back(at);
    });
  }
  /// As far as possible from a cell without passing one that matters.
  CellJump jump(const CellPosition& at, const CellJump& kind, const PreparedRay& ray) const {
    std::int64_t nearest = 1000000;
    for (const CellPosition& f : full)
      nearest = std::min(nearest, distance_between(at, f, kind, ray));
    CellJump jump = kind;
    jump.distance = static_cast<int>(std::max<std::int64_t>(1, nearest));
    return jump;
  }
};

using Visits = std::vector<std::pair<std::size_t, double>>;

/// Cells that matter, in order, with t_enter. `kind` without distance: by steps.
Visits visits_that_matter(const Sparse& sparse, const PreparedRay& ray, const CellJump& kind) {
  Visits visits;
  dda(sparse.cells, ray, [&](const CellVisit& cell) {
    if (sparse.matters[cell.index]) visits.emplace_back(cell.index, cell.t_enter);
    return kind.distance == 0 ? CellJump{1} : sparse.jump(cell.at, kind, ray);
  });
  return visits;
}

const std::vector<CellJump>& kinds_of_jumps() {
  static const std::vector<CellJump> kinds = [] {
    std::vector<CellJump> all;
    for (const CellMetric metric :
         {CellMetric::chessboard, CellMetric::city_block, CellMetric::euclid, CellMetric::octant})
      for (const unsigned layers : {0u, 4u, 2u, 3u}) all.push_back({1, metric, layers});
    return all;
  }();
  return kinds;
}

TEST(Dda, JumpsMeetTheCellsThatMatterInTheOrderOfSteps) {
  std::uint64_t seed = 5;
  for (const UniformCells& grid : grids())
    for (const std::uint32_t one_in : {8u, 40u, 200u, 100000u}) {
      const Sparse sparse(grid, one_in, ++seed);
      NastyRays rays(grid, seed);
      for (int i = 0; i < 1500; ++i) {
        const PreparedRay ray = rays.next();
        const Visits expected = visits_that_matter(sparse, ray, {0});
        for (const CellJump& kind : kinds_of_jumps())
          ASSERT_EQ(visits_that_matter(sparse, ray, kind), expected)
              << "ray " << i << " metric " << static_cast<int>(kind.metric) << " layers "
              << kind.layers << " one in " << one_in;
      }
    }
}

TEST(Dda, JumpsOfEveryMetricSaveMostStepsInEmptySpace) {
  const UniformCells cells({{0, 0, 0}, {1, 1, 1}}, {32, 32, 32});
  const Sparse sparse(cells, 10000, 9);
  Rng rng(10);
  const auto anywhere = [&] {
    const double x = rng.uniform(), y = rng.uniform();
    return Vec3d{x, y, rng.uniform()};
  };
  std::size_t steps = 0;
  std::map<CellMetric, std::size_t> jumped_steps;
  for (int i = 0; i < 500; ++i) {
    const Vec3d org = anywhere();
    const PreparedRay ray({org, anywhere() - org}, {});
    steps += visited(cells, ray).size();
    for (const CellJump& kind : kinds_of_jumps())
      if (kind.layers == 0)
        dda(cells, ray, [&](const CellVisit& cell) {
          ++jumped_steps[kind.metric];
          return sparse.jump(cell.at, kind, ray);
        });
  }
  for (const auto& [metric, count] : jumped_steps)
    EXPECT_LT(count, steps / 3) << "metric " << static_cast<int>(metric);
  EXPECT_LT(jumped_steps[CellMetric::octant], jumped_steps[CellMetric::chessboard]);
}

TEST(Dda, AJumpBeyondTheGridEndsIt) {
  const UniformCells cells({{0, 0, 0}, {9, 9, 9}}, {9, 9, 9});
  const PreparedRay ray({{-1, 0.5, 0.5}, {1, 0.3, 0.2}}, {});
  int calls = 0;
  EXPECT_FALSE(dda(cells, ray, [&](const CellVisit&) { return ++calls, 1 << 30; }));
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace strahl
