#include <algorithm>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/dynamic_tree.h>
#include <strahl/build/object_split.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

using namespace test;

std::vector<Aabb> boxes_of(const Refs& refs) {
  std::vector<Aabb> boxes;
  for (const PrimRef& ref : refs) boxes.push_back(ref.box);
  return boxes;
}

Hierarchy hierarchy_of(Refs refs, std::size_t leaf) {
  const auto splitter = make_sweep_splitter(refs, kCost);
  return make_hierarchy(
      build_object_tree(*splitter, refs.size(), box_of(refs), {kCost, leaf, 64}, {}));
}

/// Links, exact boxes, and these references once each.
void check_linked(const LinkedTree& tree, const std::vector<Aabb>& boxes,
                  const std::vector<std::uint32_t>& expected) {
  std::vector<std::uint32_t> found, waiting{tree.root};
  ASSERT_EQ(tree.nodes.at(tree.root).parent, LinkedNode::kNone);
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    const LinkedNode& node = tree.nodes.at(at);
    if (node.is_leaf()) {
      found.push_back(node.right);
      ASSERT_EQ(node.box, boxes.at(node.right));
      continue;
    }
    const LinkedNode &left = tree.nodes.at(node.left), &right = tree.nodes.at(node.right);
    ASSERT_TRUE(left.parent == at && right.parent == at);
    ASSERT_EQ(node.box, Aabb::join(left.box, right.box));
    waiting.insert(waiting.end(), {node.left, node.right});
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

std::vector<std::uint32_t> first_numbers(std::uint32_t count) {
  std::vector<std::uint32_t> all(count);
  for (std::uint32_t i = 0; i < count; ++i) all[i] = i;
  return all;
}

/// Of the nodes that are reached from the root.
double reachable_area(const LinkedTree& tree) {
  double sum = 0.0;
  std::vector<std::uint32_t> waiting{tree.root};
  while (!waiting.empty()) {
    const LinkedNode& node = tree.nodes[waiting.back()];
    waiting.pop_back();
    if (node.is_leaf()) continue;
    sum += node.box.half_area();
    waiting.insert(waiting.end(), {node.left, node.right});
  }
  return sum;
}

TEST(DynamicTree, OpensWideNodesAndLeaves) {
  const Refs refs = random_refs(300, 1);
  for (const std::size_t leaf : {1u, 7u})
    check_linked(make_linked(hierarchy_of(refs, leaf), boxes_of(refs)), boxes_of(refs),
                 first_numbers(300));
}

TEST(DynamicTree, LeavesOutWhatIsGone) {
  const Refs refs = random_refs(100, 2);
  const Hierarchy hierarchy = hierarchy_of(refs, 3);
  std::vector<Aabb> boxes = boxes_of(refs);
  std::vector<std::uint32_t> left = first_numbers(100);
  Rng rng(3);
  while (!left.empty()) {
    check_linked(make_linked(hierarchy, boxes), boxes, left);
    for (int i = 0; i < 11 && !left.empty(); ++i) {
      const auto gone = left.begin() + rng.below(static_cast<std::uint32_t>(left.size()));
      boxes[*gone] = {};
      left.erase(gone);
    }
  }
  EXPECT_TRUE(make_linked(hierarchy, boxes).nodes.empty());
}

TEST(DynamicTree, PutsEachThingInTheCheapestPlaceThereIs) {
  const Refs refs = random_refs(60, 4);
  LinkedTree tree;
  std::vector<Aabb> boxes = boxes_of(refs);
  for (std::uint32_t i = 0; i < 60; ++i) {
    double least = Aabb::kInf;
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) {
      LinkedTree tried = tree;
      const std::uint32_t pair = static_cast<std::uint32_t>(tried.nodes.size()) + 1;
      tried.nodes.push_back({boxes[i], pair, LinkedNode::kNone, i});
      tried.nodes.push_back(
          {Aabb::join(boxes[i], tried.nodes[node].box), LinkedNode::kNone, node, pair - 1});
      tried.replace_child(node, pair);
      tried.nodes[node].parent = pair;
      tried.refit_from(tried.nodes[pair].parent);
      least = std::min(least, reachable_area(tried));
    }
    insert_leaf(tree, i, boxes[i]);
    check_linked(tree, boxes, first_numbers(i + 1));
    if (i == 0) continue;
    EXPECT_NEAR(reachable_area(tree), least, 1e-12 * least) << i;
  }
}

TEST(DynamicTree, EndsItsSearchWhereAllBoxesCoincide) {
  const std::vector<Aabb> boxes(3000, Aabb{{0, 0, 0}, {1, 1, 1}});
  LinkedTree tree;
  for (std::uint32_t i = 0; i < 3000; ++i) insert_leaf(tree, i, boxes[i]);
  check_linked(tree, boxes, first_numbers(3000));
}

}  // namespace
}  // namespace strahl
