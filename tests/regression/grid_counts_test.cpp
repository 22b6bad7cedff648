// tests/regression/grid_counts_test.cpp - cells and references of uniform grids as published for
// the standard scenes [Havran1999], at the printed resolutions: objects in all cells that their
// boxes touch. A polygon is one object there, however many triangles it is here.
//
// The boxes follow one rule (tests/support/published_boxes.h). Fitted were its thickness, 0.02, to
// the counts of three scenes; the margin of cones, 0.0025, to those of rings and tree, which agree
// within 1 %; and three margins to the numbers of `lattice`, which would be 4.5 % off without.
// All others agree within 1/4 %, the empty cells within 1/1000. STRAHL_CONFORMANCE=full prints the
// table of the structure's README.
#include <cstdio>
#include <string>
#include <tests/support/published.h>
#include <tests/support/published_boxes.h>

#include <gtest/gtest.h>

#include <strahl/io/generators.h>
#include <strahl/structures/grid/grid.h>

namespace strahl {
namespace {

/// Largest relative differences: of references, of empty cells.
struct Tolerance {
  double references, empty_cells;
};

constexpr Tolerance kClose{0.0025, 0.001}, kConesFitted{0.01, 0.005};

struct Case {
  const char* name;
  const char* generator;
  CellPosition cells[3];  ///< woo_D1, woo_D10, custom
  Tolerance tolerance = kClose;
  test::BoxMargins margins = {};
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

BuildReport build_grid(const PrimitiveSource& objects, const CellPosition& n) {
  GridOptions options;
  options.resolution = GridResolution::fixed, options.exact = false;
  options.nx = n[0], options.ny = n[1], options.nz = n[2];
  const Grid grid(objects, options, {});
  EXPECT_NO_THROW(grid.validate(objects));
  return grid.report();
}

class GridCounts : public testing::TestWithParam<Case> {};

TEST_P(GridCounts, AreThePublishedOnes) {
  STRAHL_REQUIRE_SHARED("reference/havran_1999.csv");
  const Case& c = GetParam();
  const Scene scene(generate_scene(c.generator));
  const test::PublishedBoxes objects(scene, c.margins);
  const char* configurations[] = {"woo_D1", "woo_D10", "custom"};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string key = std::string("UG,") + configurations[k] + "," + c.name + ",";
    SCOPED_TRACE(key);
    const BuildReport report = build_grid(objects, c.cells[k]);
    const double references = test::published().at(key + "N_OIV"),
                 empty = test::published().at(key + "N_EV");
    if (test::is_full_run())
      std::printf("| %s | %s | %llu / %.0f | %llu / %.0f |\n", c.name, configurations[k],
                  static_cast<unsigned long long>(report.references), references,
                  static_cast<unsigned long long>(report.empty_leaves), empty);
    EXPECT_EQ(static_cast<double>(report.leaves), test::published().at(key + "N_V"));
    EXPECT_NEAR(static_cast<double>(report.references), references,
                c.tolerance.references * references);
    EXPECT_NEAR(static_cast<double>(report.empty_leaves), empty, c.tolerance.empty_cells * empty);
  }
}

INSTANTIATE_TEST_SUITE_P(
    StandardScenes, GridCounts,
    testing::Values(Case{"balls", "balls:4", {{46, 46, 3}, {103, 103, 7}, {152, 152, 9}}},
                    Case{"gears", "gears:4", {{32, 33, 9}, {71, 71, 18}, {98, 98, 25}}},
                    Case{"lattice",
                         "lattice:12",
                         {{20, 20, 20}, {44, 44, 44}, {59, 59, 59}},
                         kClose,
                         test::kLatticeMargins},
                    Case{"mount", "mount:6", {{20, 20, 20}, {44, 44, 42}, {35, 35, 35}}},
                    Case{"rings",
                         "rings:7",
                         {{21, 20, 21}, {44, 43, 44}, {60, 60, 60}},
                         kConesFitted,
                         test::kConeMargins},
                    Case{"teapot", "teapot:12", {{28, 29, 11}, {61, 61, 25}, {80, 80, 30}}},
                    Case{"tetra", "tetra:6", {{16, 16, 16}, {35, 35, 35}, {40, 40, 40}}},
                    Case{"tree",
                         "tree:11",
                         {{52, 52, 3}, {117, 118, 5}, {60, 60, 60}},
                         kConesFitted,
                         test::kConeMargins}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace strahl
