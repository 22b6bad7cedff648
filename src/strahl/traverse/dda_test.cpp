#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/traverse/dda.h>

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

/// Rays that make trouble in a grid of cells.
class NastyRays {
 public:
  NastyRays(const UniformCells& cells, std::uint64_t seed) : cells_(cells), rng_(seed) {}

  PreparedRay next() {
    Ray ray{point(), {}};
    const Vec3d target = point();
    ray.dir = rng_.below(3) == 0 ? small_direction() : target - ray.org;
    for (int a = 0; a < 3; ++a)
      if (rng_.below(6) == 0) ray.dir[a] = 0.0;
    if (norm_max(ray.dir) == 0.0) ray.dir.y = -1.0;
    if (rng_.below(3) == 0) {
      const double distances[] = {1.0, 30.0, 1e6, 1e12, 1e15, 1e18, 1e30};
      ray.org = target - distances[rng_.below(7)] / norm_max(ray.dir) * ray.dir;
    }
    if (rng_.below(4) == 0) ray.t_min = rng_.uniform(), ray.t_max = ray.t_min + rng_.uniform();
    RayFrame frame;
    frame.bounds = {{}, {}};
    if (rng_.below(3) == 0) frame.widen_absolute = std::pow(10.0, rng_.uniform(-16, 0));
    if (rng_.below(3) == 0) frame.widen_per_org = 1e-15;
    return PreparedRay(ray, frame);
  }

 private:
  Vec3d small_direction() {
    const auto whole = [&] { return static_cast<double>(rng_.below(5)) - 2; };
    const double x = whole(), y = whole();
    return {x, y, whole()};
  }
  /// A corner of a cell, a point in a plane between cells, or any point in or near the grid.
  Vec3d point() {
    Vec3d p;
    const bool is_corner = rng_.below(2) == 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = cells_.plane(a, 0), hi = cells_.plane(a, cells_.n(a));
      const auto plane = static_cast<int>(rng_.below(static_cast<std::uint32_t>(cells_.n(a)) + 1));
      p[a] = is_corner || rng_.below(3) == 0 ? cells_.plane(a, plane)
                                             : lo + rng_.uniform(-0.3, 1.3) * (hi - lo);
    }
    return p;
  }

  const UniformCells& cells_;
  Rng rng_;
};

std::vector<UniformCells> grids() {
  return {UniformCells({{0, 0, 0}, {8, 8, 8}}, {8, 8, 8}),
          UniformCells({{-1, 2, 1000.1}, {1, 2.1, 1000.7}}, {7, 13, 3}),
          UniformCells({{0, 0, 5}, {1, 3, 5}}, {6, 11, 1}),
          UniformCells({{1e5, 1e5, 1e5}, {1e5 + 1, 1e5 + 0.7, 1e5 + 0.3}}, {9, 5, 4}),
          UniformCells({{-3, -3, -3}, {3, 3, 3}}, {1, 1, 1})};
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

/// A grid of which some cells matter, and how far the nearest of those is, at least 1.
struct Sparse {
  UniformCells cells;
  std::vector<bool> matters;
  std::vector<int> distance;

  Sparse(const UniformCells& grid, std::uint32_t one_in, std::uint64_t seed) : cells(grid) {
    Rng rng(seed);
    std::vector<CellPosition> full;
    for_cells(cells, [&](const CellPosition& at) {
      matters.push_back(rng.below(one_in) == 0);
      if (matters.back()) full.push_back(at);
    });
    for_cells(cells, [&](const CellPosition& at) {
      int nearest = 1000;
      for (const CellPosition& f : full) {
        int far = 0;
        for (std::size_t a = 0; a < 3; ++a) far = std::max(far, std::abs(at[a] - f[a]));
        nearest = std::min(nearest, far);
      }
      distance.push_back(std::max(1, nearest));
    });
  }
};

TEST(Dda, JumpsOverCellsWithoutMissingOneThatMatters) {
  std::uint64_t seed = 5;
  for (const UniformCells& grid : grids())
    for (const std::uint32_t one_in : {20u, 200u, 100000u}) {
      const Sparse sparse(grid, one_in, ++seed);
      NastyRays rays(grid, seed);
      for (int i = 0; i < 3000; ++i) {
        const PreparedRay ray = rays.next();
        const std::vector<std::size_t> all = visited(grid, ray);
        std::vector<std::size_t> expected, met;
        for (const std::size_t c : all)
          if (sparse.matters[c]) expected.push_back(c);
        double t = 0.0;
        dda(grid, ray, [&](const CellVisit& cell) {
          EXPECT_LE(t, cell.t_enter);
          t = cell.t_enter;
          if (sparse.matters[cell.index]) met.push_back(cell.index);
          return sparse.distance[cell.index];
        });
        std::sort(met.begin(), met.end()), std::sort(expected.begin(), expected.end());
        ASSERT_EQ(met, expected) << "ray " << i;
      }
    }
}

TEST(Dda, JumpsSaveMostStepsInEmptySpace) {
  const UniformCells cells({{0, 0, 0}, {1, 1, 1}}, {32, 32, 32});
  const Sparse sparse(cells, 10000, 9);
  Rng rng(10);
  const auto anywhere = [&] {
    const double x = rng.uniform(), y = rng.uniform();
    return Vec3d{x, y, rng.uniform()};
  };
  std::size_t steps = 0, jumped_steps = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3d org = anywhere();
    const PreparedRay ray({org, anywhere() - org}, {});
    steps += visited(cells, ray).size();
    dda(cells, ray, [&](const CellVisit& cell) {
      ++jumped_steps;
      return sparse.distance[cell.index];
    });
  }
  EXPECT_LT(jumped_steps, steps / 3);
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
