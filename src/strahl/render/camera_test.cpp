#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/render/camera.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

View straight_view() { return {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 90.0, 4, 2}; }

TEST(Camera, CornerRaysGoRowByRowFromTheTopLeft) {
  const std::vector<Ray> rays = corner_rays(Camera(straight_view()));
  ASSERT_EQ(rays.size(), 15u);
  const auto expect_dir = [&](std::size_t i, const Vec3d& dir) {
    EXPECT_NEAR(rays[i].dir.x, dir.x, 1e-15);
    EXPECT_NEAR(rays[i].dir.y, dir.y, 1e-15);
    EXPECT_NEAR(rays[i].dir.z, dir.z, 1e-15);
  };
  expect_dir(0, {-2, 1, -1});
  expect_dir(4, {2, 1, -1});
  expect_dir(7, {0, 0, -1});
  expect_dir(14, {2, -1, -1});
  EXPECT_EQ(rays[0].org, (Vec3d{0, 0, 5}));
}

TEST(Camera, ImpossibleViewsAreUsageErrors) {
  std::vector<View> views(6, straight_view());
  views[0].at = views[0].from;
  views[1].fov_degrees = 0.0;
  views[2].fov_degrees = 180.0;
  views[3].width = 0;
  views[4].from.x = std::numeric_limits<double>::quiet_NaN();
  views[5].fov_degrees = std::numeric_limits<double>::quiet_NaN();
  for (const View& view : views) {
    try {
      const Camera camera(view);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
    }
  }
}

TEST(Camera, UpAlongTheViewIsReplaced) {
  View view = straight_view();
  view.up = {0, 0, 1};
  const Camera camera(view);
  EXPECT_NEAR(length(camera.right()), 1.0, 1e-15);
  EXPECT_NEAR(dot(camera.up(), camera.forward()), 0.0, 1e-15);
}

/// How far out of the middle of the image the boxes reach; 1 is its border.
double reach(const std::vector<Aabb>& boxes, const Camera& camera) {
  const Ray top_right = camera.through(camera.width(), 0);
  double largest = 0.0;
  for (const Aabb& box : boxes) {
    for (int corner = 0; corner < 8 && !box.is_empty(); ++corner) {
      const Vec3d p = Vec3d{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                            corner & 4 ? box.hi.z : box.lo.z} -
                      camera.eye();
      const double depth = dot(p, camera.forward());
      EXPECT_GT(depth, 0.0);
      const double x = dot(p, camera.right()) / depth / dot(top_right.dir, camera.right());
      const double y = dot(p, camera.up()) / depth / dot(top_right.dir, camera.up());
      largest = std::max({largest, std::abs(x), std::abs(y)});
    }
  }
  return largest;
}

TEST(Framing, AllBoxesAreInsideTheImageAndFillIt) {
  const std::vector<Aabb> wide{{{0, 0, 0}, {3, 1, 1}}, {{-1, 0, 7}, {0, 1, 8}}, {}};
  const std::vector<Aabb> tall{{{0, 0, 0}, {1, 9, 1}}, {{0, 20, 0}, {2, 21, 1}}};
  for (const std::vector<Aabb>& boxes : {wide, tall}) {
    const View view = frame_boxes(boxes, {-0.5, -0.4, -1.0}, {0, 1, 0}, 40.0, 300, 200);
    EXPECT_LT(reach(boxes, Camera(view)), 1.0);
    EXPECT_GT(reach(boxes, Camera(view)), 0.9);
  }
}

TEST(Framing, EmptySceneAndSinglePointHaveAView) {
  EXPECT_NO_THROW(Camera(frame_boxes({}, {0, 0, -1}, {0, 1, 0}, 40.0, 30, 20)));
  const std::vector<Aabb> point{{{5, 5, 5}, {5, 5, 5}}};
  EXPECT_NO_THROW(Camera(frame_boxes(point, {0, 0, -1}, {0, 1, 0}, 40.0, 30, 20)));
}

}  // namespace
}  // namespace strahl
