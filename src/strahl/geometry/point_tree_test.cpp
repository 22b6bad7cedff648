// geometry/point_tree_test.cpp - searches against a loop over all points.
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/point_tree.h>

namespace strahl {
namespace {

bool inside(const Box2& box, const Point2& p) {
  return p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y;
}

bool overlap(const Box2& a, const Box2& b) {
  return a.low.x <= b.high.x && a.high.x >= b.low.x && a.low.y <= b.high.y && a.high.y >= b.low.y;
}

bool any_marked_in(const PointTree& tree, const std::vector<Point2>& points, const Box2& region) {
  return tree.any_marked([&](const Box2& box) { return overlap(box, region); },
                         [&](std::uint32_t i) { return inside(region, points[i]); });
}

TEST(PointTree, FindsExactlyTheMarkedPoints) {
  Rng rng(3);
  std::vector<Point2> points;
  // Few distinct coordinates, so that many points share them.
  for (int i = 0; i < 500; ++i) points.push_back({0.5 * rng.below(20), 0.5 * rng.below(20)});
  PointTree tree(points);
  std::vector<bool> marked(points.size(), false);
  for (int step = 0; step < 5000; ++step) {
    const std::uint32_t i = rng.below(500);
    marked[i] = rng.below(4) == 0;
    tree.set_marked(i, marked[i]);
    const double x = 0.5 * rng.below(20), y = 0.5 * rng.below(20);
    const Box2 region{{x, y}, {x + 0.5, y + 0.5}};
    bool expected = false;
    for (std::size_t j = 0; j < points.size(); ++j) {
      expected = expected || (marked[j] && inside(region, points[j]));
    }
    ASSERT_EQ(any_marked_in(tree, points, region), expected) << step;
  }
}

TEST(PointTree, MarkingTwiceIsMarkingOnce) {
  const std::vector<Point2> points(40, Point2{1, 1});
  PointTree tree(points);
  tree.set_marked(7, true), tree.set_marked(7, true);
  EXPECT_TRUE(any_marked_in(tree, points, {{0, 0}, {2, 2}}));
  tree.set_marked(7, false);
  EXPECT_FALSE(tree.is_marked(7));
  EXPECT_FALSE(any_marked_in(tree, points, {{0, 0}, {2, 2}}));
}

}  // namespace
}  // namespace strahl
