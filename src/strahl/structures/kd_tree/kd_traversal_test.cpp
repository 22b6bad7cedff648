// Traversals of a kd-tree over trees made by hand, whose planes, rays and points are exact in
// double: every closed cell that holds a point of the ray is visited, and hardly any other.
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/kd_tree/kd_tree.h>

namespace strahl {
namespace {

constexpr KdTraversal kTraversals[] = {KdTraversal::stack, KdTraversal::havran, KdTraversal::skip,
                                       KdTraversal::ropes};
const char* name_of(KdTraversal traversal) {
  const char* const names[] = {"stack", "havran", "skip", "ropes"};
  return names[static_cast<std::size_t>(traversal)];
}

/// A tree whose leaves refer to their own number, with the cells of the leaves.
struct Made {
  Aabb root;
  KdArrays arrays;
  std::vector<Aabb> cells;
  KdNodes nodes;
  KdLinks gates, ropes;

  void link(KdNodeBytes distance = KdNodeBytes::b8) {
    nodes = KdNodes(arrays.nodes, distance, 0, {});
    gates = make_gates(nodes, root, 0, {});
    ropes = make_ropes(nodes, root, 0, {});
  }
};

/// Divides cells at integers until they are one wide, or by chance earlier.
void divide(Made& made, const Aabb& cell, Rng& rng) {
  const int axis = static_cast<int>(rng.below(3));
  const double lo = std::floor(cell.lo[axis]) + 1, hi = std::ceil(cell.hi[axis]) - 1;
  if (hi < lo || (rng.below(12) == 0 && cell != made.root)) {
    made.arrays.nodes.push_back(KdNode::leaf(static_cast<std::uint32_t>(made.cells.size()), 1));
    made.cells.push_back(cell);
    return;
  }
  const double plane = lo + rng.below(static_cast<std::uint32_t>(hi - lo) + 1);
  const std::size_t at = made.arrays.nodes.size();
  made.arrays.nodes.push_back(
      KdNode::inner(static_cast<std::size_t>(axis), static_cast<float>(plane)));
  Aabb below = cell, above = cell;
  below.hi[axis] = above.lo[axis] = plane;
  divide(made, below, rng);
  made.arrays.nodes[at].link_right(made.arrays.nodes.size());
  divide(made, above, rng);
}

Made make_tree(std::uint64_t seed, const Aabb& root = {{-4, -4, -4}, {4, 4, 4}}) {
  Rng rng(seed);
  Made made;
  made.root = root;
  divide(made, root, rng);
  made.link();
  return made;
}

struct EveryHit {
  double t_max() const { return std::numeric_limits<double>::infinity(); }
};

/// Collects the leaves it is shown; stops at the first if told to.
struct Seen {
  std::set<std::uint32_t> leaves;
  bool stops = false;
  std::size_t calls = 0;
  template <class Q, class C>
  bool visit(std::uint32_t leaf, const PreparedRay&, Q&, C&) {
    leaves.insert(leaf), ++calls;
    return stops;
  }
};

template <class Q = EveryHit>
void trace(const Made& made, KdTraversal traversal, const PreparedRay& ray, Seen& seen,
           Q query = {}) {
  NoCounters none;
  const auto& references = made.arrays.references;
  const KdView<true> view(made.nodes, references,
                          traversal == KdTraversal::skip ? made.gates : made.ropes, made.root);
  if (traversal == KdTraversal::stack) walk(view, seen, ray, query, none);
  if (traversal == KdTraversal::havran) walk_by_points(view, seen, ray, query, none);
  if (traversal == KdTraversal::skip) walk_by_skips(view, seen, ray, query, none);
  if (traversal == KdTraversal::ropes) walk_by_ropes(view, seen, ray, query, none);
}

Aabb grown(Aabb box, double by) {
  box.lo = box.lo - Vec3d::all(by), box.hi = box.hi + Vec3d::all(by);
  return box;
}

/// Where every sum and product of the points at quarters of t is exact: on planes, edges, corners,
/// in planes, parallel to axes, away from all planes, from far away.
Ray exact_ray(Rng& rng) {
  Ray ray;
  do {
    for (int axis = 0; axis < 3; ++axis) ray.dir[axis] = static_cast<double>(rng.below(5)) - 2.0;
  } while (norm_max(ray.dir) == 0.0);
  for (int axis = 0; axis < 3; ++axis)
    ray.org[axis] = (static_cast<double>(rng.below(25)) - 12) / 2;
  if (rng.below(5) == 0) ray.org = ray.org - 0x1p20 * ray.dir;
  if (rng.below(5) == 0) ray.org = ray.org - 8.0 * ray.dir;
  return ray;
}

/// Parameters in quarters at which the ray may be near the cells.
std::vector<double> quarters(const Ray& ray) {
  const double middle = std::floor(norm_max(ray.org) / norm_max(ray.dir));
  std::vector<double> all;
  for (double t = std::max(0.0, middle - 24); t < middle + 24; t += 0.25) all.push_back(t);
  return all;
}

void expect_all_cells(const Made& made, const Ray& ray, double widening) {
  RayFrame frame;
  frame.bounds = made.root;
  frame.widen_absolute = widening;
  const PreparedRay prepared(ray, frame);
  std::set<std::uint32_t> needed;
  for (const double t : quarters(ray)) {
    const Vec3d point = ray.org + t * ray.dir;
    for (std::uint32_t leaf = 0; leaf < made.cells.size(); ++leaf)
      if (grown(made.cells[leaf], 0.5 * widening).contains(point)) needed.insert(leaf);
  }
  for (const KdTraversal traversal : kTraversals) {
    Seen seen;
    trace(made, traversal, prepared, seen);
    EXPECT_TRUE(std::includes(seen.leaves.begin(), seen.leaves.end(), needed.begin(), needed.end()))
        << name_of(traversal) << " from " << ray.org.x << ' ' << ray.org.y << ' ' << ray.org.z
        << " along " << ray.dir.x << ' ' << ray.dir.y << ' ' << ray.dir.z;
    for (const std::uint32_t leaf : seen.leaves) {
      const Aabb box = grown(made.cells[leaf], widening + 1e-6);
      const Interval in = clip_to_box(prepared, box.lo, box.hi, {0.0, 1e30});
      EXPECT_LE(in.t_enter, in.t_exit) << name_of(traversal) << " visits what is far off";
    }
  }
}

TEST(KdTraversal, MeetsEveryClosedCellThatARayTouches) {
  Rng rng(1);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Made made = make_tree(seed);
    for (int i = 0; i < 400; ++i) expect_all_cells(made, exact_ray(rng), 0.0);
  }
}

TEST(KdTraversal, MeetsEveryCellWithinTheWideningOfARay) {
  Rng rng(2);
  const Made made = make_tree(4);
  for (const double widening : {1e-9, 0.25, 2.0})
    for (int i = 0; i < 100; ++i) expect_all_cells(made, exact_ray(rng), widening);
}

TEST(KdTraversal, MeetsEveryCellOfAFlatTree) {
  Rng rng(3);
  const Made made = make_tree(5, {{-4, -4, 1}, {4, 4, 1}});
  for (int i = 0; i < 300; ++i) {
    Ray ray = exact_ray(rng);
    if (i % 2 == 0) ray.org.z = 1, ray.dir = {ray.dir.x, 1.0, 0.0};
    expect_all_cells(made, ray, 0.0);
  }
}

/// The seed's rule "t_split < t_min: far" sends a ray that leaves a plane behind to the wrong side.
TEST(KdTraversal, KeepsToTheNearSideOfAPlaneBehindTheRay) {
  Made made;
  made.root = {{-4, -4, -4}, {4, 4, 4}};
  made.cells = {{{-4, -4, -4}, {0, 4, 4}}, {{0, -4, -4}, {4, 4, 4}}};
  made.arrays.nodes = {KdNode::inner(0, 0.0f), KdNode::leaf(0, 1), KdNode::leaf(1, 1)};
  made.arrays.nodes[0].link_right(2);
  made.link();
  RayFrame frame;
  frame.bounds = made.root;
  for (const KdTraversal traversal : kTraversals)
    for (const double side : {-1.0, 1.0}) {
      Seen seen;
      trace(made, traversal, PreparedRay({{side, 0.5, 0.5}, {side, 0.25, 0.125}}, frame), seen);
      EXPECT_EQ(seen.leaves, std::set<std::uint32_t>{side > 0}) << name_of(traversal);
    }
}

TEST(KdTraversal, VisitsNoCellTwiceWhereNoPlaneIsTouched) {
  Rng rng(6);
  const Made made = make_tree(6);
  RayFrame frame;
  frame.bounds = made.root;
  for (int i = 0; i < 300; ++i) {
    Vec3d org, dir;
    for (int axis = 0; axis < 3; ++axis)
      org[axis] = rng.uniform(-5, 5), dir[axis] = rng.uniform(-1, 1);
    Seen expected;
    trace(made, KdTraversal::stack, PreparedRay({org, dir}, frame), expected);
    for (const KdTraversal traversal : kTraversals) {
      Seen seen;
      trace(made, traversal, PreparedRay({org, dir}, frame), seen);
      EXPECT_EQ(seen.leaves, expected.leaves) << name_of(traversal);
      EXPECT_EQ(seen.calls, seen.leaves.size()) << name_of(traversal);
    }
  }
}

TEST(KdTraversal, StopsWhenTheQueryDoes) {
  const Made made = make_tree(7);
  RayFrame frame;
  frame.bounds = made.root;
  for (const Vec3d& org : {Vec3d{-9, 0.3, 0.4}, Vec3d{-9, 0, 0}, Vec3d{1, 1, 1}})
    for (const KdTraversal traversal : kTraversals) {
      Seen seen;
      seen.stops = true;
      trace(made, traversal, PreparedRay({org, {1, 0, 0}}, frame), seen);
      EXPECT_EQ(seen.calls, 1u) << name_of(traversal);
    }
}

struct Until {
  double t;
  double t_max() const { return t; }
};

TEST(KdTraversal, SkipsWhatBeginsBeyondTheBestHit) {
  const Made made = make_tree(8);
  RayFrame frame;
  frame.bounds = made.root;
  const PreparedRay ray({{-6, 0.3, 0.4}, {1, 0.01, 0.02}}, frame);
  for (const KdTraversal traversal : kTraversals) {
    Seen seen, all;
    trace(made, traversal, ray, seen, Until{4.5});
    trace(made, traversal, ray, all);
    EXPECT_LT(seen.leaves.size(), all.leaves.size()) << name_of(traversal);
    for (const std::uint32_t leaf : seen.leaves)
      EXPECT_LE(made.cells[leaf].lo.x, -1.0) << name_of(traversal);
  }
}

/// A change to the links, and what the check has to say about it.
template <class Check>
void expect_fault(const KdLinks& links, const Made& made, Check check, const std::string& broken,
                  const std::function<void(KdLinks&)>& plant) {
  KdLinks wrong = links;
  plant(wrong);
  try {
    check(wrong, made.nodes, made.root);
    ADD_FAILURE() << "not noticed: " << broken;
  } catch (const std::logic_error& error) {
    EXPECT_EQ(error.what(), "kd_tree: " + broken);
  }
}

TEST(KdTraversal, ValidateNoticesWrongGates) {
  const Made made = make_tree(9);
  EXPECT_NO_THROW(check_gates(made.gates, made.nodes, made.root));
  const auto expect = [&](const char* broken, const std::function<void(KdLinks&)>& plant) {
    expect_fault(made.gates, made, check_gates, broken, plant);
  };
  expect("a gate does not end behind its subtree", [](KdLinks& l) { ++l.gates[3].end; });
  expect("a gate does not end behind its subtree", [](KdLinks& l) { --l.gates.back().end; });
  expect("a gate is not the cell of its subtree", [](KdLinks& l) { l.gates[5].lo[1] += 1; });
  expect("a gate is not the cell of its subtree", [](KdLinks& l) { l.gates[5].hi[2] += 1; });
  expect("not one gate per inner node", [](KdLinks& l) { l.gates.pop_back(); });
}

TEST(KdTraversal, ValidateNoticesWrongRopes) {
  const Made made = make_tree(10);
  EXPECT_NO_THROW(check_ropes(made.ropes, made.nodes, made.root));
  const auto expect = [&](const char* broken, const std::function<void(KdLinks&)>& plant) {
    expect_fault(made.ropes, made, check_ropes, broken, plant);
  };
  // A cell with neighbours on both sides of an axis, and the place of those ropes.
  std::size_t at = 0;
  while (made.ropes.cells[at].rope[0] == RopedCell::kNoRope ||
         made.ropes.cells[at].rope[1] == RopedCell::kNoRope)
    ++at;
  expect("a rope leads to what is not at its face",
         [&](KdLinks& l) { std::swap(l.cells[at].rope[0], l.cells[at].rope[1]); });
  expect("a rope leads to what is not at its face", [&](KdLinks& l) { l.cells[at].rope[0] = 0; });
  expect("a rope is missing or leaves the scene",
         [&](KdLinks& l) { l.cells[at].rope[0] = RopedCell::kNoRope; });
  expect("a face is not that of its cell", [&](KdLinks& l) { l.cells[at].face[1] += 1; });
  expect("a place is not the number of leaves before it", [](KdLinks& l) { ++l.place[7]; });
  expect("not one roped cell per leaf", [](KdLinks& l) { l.cells.pop_back(); });
}

TEST(KdTraversal, ValidateNoticesRopesThatAreNotPushedDown) {
  // Two cells side by side above two others divided alike: ropes upward lead to leaves.
  Made made;
  made.root = {{0, 0, 0}, {2, 2, 2}};
  made.arrays.nodes = {KdNode::inner(2, 1.0f), KdNode::inner(0, 1.0f), KdNode::leaf(0, 1),
                       KdNode::leaf(1, 1),     KdNode::inner(0, 1.0f), KdNode::leaf(2, 1),
                       KdNode::leaf(3, 1)};
  made.arrays.nodes[0].link_right(4), made.arrays.nodes[1].link_right(3);
  made.arrays.nodes[4].link_right(6);
  made.link();
  EXPECT_EQ(made.ropes.cells[0].rope[5], 5u);
  EXPECT_EQ(made.ropes.cells[3].rope[4], 3u);
  EXPECT_NO_THROW(check_ropes(made.ropes, made.nodes, made.root));
  expect_fault(made.ropes, made, check_ropes, "a rope is not pushed down",
               [](KdLinks& l) { l.cells[0].rope[5] = 4; });
}

TEST(KdTraversal, LinksKeepToTheMemoryLimitAndCanBeCancelled) {
  const Made made = make_tree(11);
  for (const auto make : {make_gates, make_ropes}) {
    const std::uint64_t bytes = make(made.nodes, made.root, 0, {}).bytes();
    BuildContext context;
    context.memory_limit = bytes + 100;
    EXPECT_EQ(make(made.nodes, made.root, 100, context).bytes(), bytes);
    EXPECT_THROW(make(made.nodes, made.root, 101, context), Error);
    context.progress = [](double, std::string_view stage) { return stage != "linking"; };
    EXPECT_THROW(make(made.nodes, made.root, 0, context), Error);
  }
  BuildContext context;
  context.memory_limit = 64 * made.nodes.size();
  EXPECT_THROW(KdNodes(made.arrays.nodes, KdNodeBytes::b64, 0, context), Error);
}

TEST(KdTraversal, LayoutIsNotPartOfTheTree) {
  const auto scene = test::soup(2000, 0.02, 12).scene();
  const auto plain = build(scene, "kd_tree");
  const std::uint64_t nodes = plain->report().nodes, leaves = plain->report().leaves;
  const std::uint64_t others = plain->report().bytes - 8 * nodes;
  const auto expect = [&](const char* spec, std::uint64_t bytes) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate()) << spec;
    EXPECT_EQ(tree->tree_hash(), plain->tree_hash()) << spec;
    EXPECT_EQ(tree->report().sah_cost, plain->report().sah_cost) << spec;
    EXPECT_NEAR(static_cast<double>(tree->report().bytes), static_cast<double>(others + bytes), 63)
        << spec;
  };
  expect("kd_tree:node_bytes=16", 16 * nodes);
  expect("kd_tree:node_bytes=32", 32 * nodes);
  expect("kd_tree:node_bytes=64", 64 * nodes);
  expect("kd_tree:traversal=havran", 8 * nodes);
  expect("kd_tree:traversal=skip", 8 * nodes + 32 * (leaves - 1));
  expect("kd_tree:traversal=ropes", 8 * nodes + 48 * leaves + 4 * nodes);
}

TEST(KdTraversal, PaddedNodesAreFoundWhereTheyLie) {
  Rng rng(13);
  Made made = make_tree(13);
  const PreparedRay ray({{-6, 0.3, 0.4}, {1, 0.1, 0.2}}, RayFrame{made.root});
  Seen expected;
  trace(made, KdTraversal::stack, ray, expected);
  for (const KdNodeBytes bytes : {KdNodeBytes::b16, KdNodeBytes::b32, KdNodeBytes::b64}) {
    made.link(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(&made.nodes[1]) -
                  reinterpret_cast<std::uintptr_t>(&made.nodes[0]),
              static_cast<std::uintptr_t>(bytes));
    Seen seen;
    trace(made, KdTraversal::stack, ray, seen);
    EXPECT_EQ(seen.leaves, expected.leaves);
  }
}

}  // namespace
}  // namespace strahl
