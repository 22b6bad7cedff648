// tests/regression/grid_counts_test.cpp - cells and references of uniform grids as published for
// the standard scenes [Havran1999], at the printed resolutions: objects in all cells that their
// boxes touch. A polygon is one object there, however many triangles it is here.
//
// References agree within 1 % where no reason is given. What the publication does not say, one
// choice per scene has to explain at all three resolutions: by how much boxes of objects are
// enlarged, and whether the box of a cylinder is that of the spheres around its ends.
#include <string>
#include <tests/support/face_source.h>
#include <tests/support/published.h>

#include <gtest/gtest.h>

#include <strahl/io/generators.h>
#include <strahl/structures/grid/grid.h>

namespace strahl {
namespace {

enum class ConeBox { surface, end_spheres };

struct Case {
  const char* name;
  const char* generator;
  CellPosition cells[3];  ///< woo_D1, woo_D10, custom
  double enlarged;        ///< by how much boxes of objects are larger on each side
  ConeBox cones;
  double tolerance[3];
  const char* reason;  ///< for tolerances above 1 %
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name << ' ' << c.reason; }

Aabb box_of_end_spheres(const Cone& cone) {
  const Vec3d base = Vec3d::all(cone.base_radius), apex = Vec3d::all(cone.apex_radius);
  return Aabb::join({cone.base - base, cone.base + base}, {cone.apex - apex, cone.apex + apex});
}

/// Polygons as objects, with the boxes of the case.
class Objects : public test::FaceSource {
 public:
  Objects(const Scene& scene, const Case& c) : FaceSource(scene) {
    for (std::uint32_t i = 0; i < size(); ++i) boxes_.push_back(FaceSource::bounds(i));
    const Geometry& last = scene.geometries().back();  // cones come last
    const std::size_t first = boxes_.size() - last.cones.size();
    if (c.cones == ConeBox::end_spheres)
      for (std::size_t i = 0; i < last.cones.size(); ++i)
        boxes_[first + i] = box_of_end_spheres(last.cones[i]);
    for (Aabb& box : boxes_)
      box.lo = box.lo - Vec3d::all(c.enlarged), box.hi = box.hi + Vec3d::all(c.enlarged);
  }
  Aabb bounds(std::uint32_t i) const override { return boxes_[i]; }

 private:
  std::vector<Aabb> boxes_;
};

BuildReport build_grid(const Objects& objects, const CellPosition& n) {
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
  const Objects objects(scene, c);
  const char* configurations[] = {"woo_D1", "woo_D10", "custom"};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string key = std::string("UG,") + configurations[k] + "," + c.name + ",";
    SCOPED_TRACE(key);
    const BuildReport report = build_grid(objects, c.cells[k]);
    const double references = test::published().at(key + "N_OIV"),
                 empty = test::published().at(key + "N_EV");
    EXPECT_EQ(static_cast<double>(report.leaves), test::published().at(key + "N_V"));
    EXPECT_NEAR(static_cast<double>(report.references), references, c.tolerance[k] * references);
    EXPECT_NEAR(static_cast<double>(report.empty_leaves), empty,
                (c.tolerance[k] > 0.01 ? 0.06 : 0.021) * empty);
  }
}

INSTANTIATE_TEST_SUITE_P(
    StandardScenes, GridCounts,
    testing::Values(
        Case{"balls",
             "balls:4",
             {{46, 46, 3}, {103, 103, 7}, {152, 152, 9}},
             0.0,
             ConeBox::surface,
             {0.01, 0.01, 0.01},
             ""},
        Case{"gears",
             "gears:4",
             {{32, 33, 9}, {71, 71, 18}, {98, 98, 25}},
             0.0121,
             ConeBox::surface,
             {0.1, 0.1, 0.1},
             "gears of a layer end in one plane, so that by which cells it passes decides over a "
             "tenth of all references, and the published box is four times as high as the scene"},
        Case{"lattice",
             "lattice:12",
             {{20, 20, 20}, {44, 44, 44}, {59, 59, 59}},
             0.0,
             ConeBox::end_spheres,
             {0.0, 0.0, 0.01},
             ""},
        Case{"mount",
             "mount:6",
             {{20, 20, 20}, {44, 44, 42}, {35, 35, 35}},
             0.0005,
             ConeBox::surface,
             {0.02, 0.02, 0.02},
             "the published box is a cube, which the scene is not, nor are 44 x 44 x 42 cells in "
             "it"},
        Case{"rings",
             "rings:7",
             {{21, 20, 21}, {44, 43, 44}, {60, 60, 60}},
             0.0031,
             ConeBox::surface,
             {0.016, 0.016, 0.016},
             "boxes of slanted cylinders are evidently larger there than the surface's, which miss "
             "4 %, and smaller than those of the end spheres, which are 4 % too many"},
        Case{"teapot",
             "teapot:12",
             {{28, 29, 11}, {61, 61, 25}, {80, 80, 30}},
             0.0019,
             ConeBox::surface,
             {0.027, 0.027, 0.027},
             "the published box is 0.04 higher than the scene, by what part of it is not said"},
        Case{"tetra",
             "tetra:6",
             {{16, 16, 16}, {35, 35, 35}, {40, 40, 40}},
             0.0,
             ConeBox::surface,
             {0.0, 0.0, 0.0},
             ""},
        Case{"tree",
             "tree:11",
             {{52, 52, 3}, {117, 118, 5}, {60, 60, 60}},
             0.001,
             ConeBox::end_spheres,
             {0.01, 0.01, 0.01},
             ""}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace strahl
