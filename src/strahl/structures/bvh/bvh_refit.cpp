#include <algorithm>
#include <utility>
#include <vector>

#include <strahl/build/dynamic_tree.h>
#include <strahl/structures/bvh/bvh_leaves.h>
#include <strahl/structures/bvh/bvh_refit.h>

namespace strahl {
namespace {

constexpr std::size_t kGrain = 4096;

std::vector<Aabb> bound_all(const PrimitiveSource& source, const BuildContext& context) {
  context.require_memory(std::uint64_t{source.size()} * sizeof(Aabb), "boxes of moved primitives");
  std::vector<Aabb> boxes(source.size());
  context.executor.parallel_for(0, boxes.size(), kGrain, [&](std::size_t from, std::size_t to) {
    context.check(0.0, "fitting");
    for (std::size_t i = from; i < to; ++i) boxes[i] = source.bounds(static_cast<std::uint32_t>(i));
  });
  return boxes;
}

std::vector<bool> known_things(const Hierarchy& hierarchy, std::size_t size) {
  std::vector<bool> is_known(size);
  for (const std::uint32_t reference : hierarchy.references) is_known[reference] = true;
  return is_known;
}

/// Boxes of the same nodes, from the leaves up.
void fit_boxes(Hierarchy& hierarchy, const std::vector<Aabb>& boxes) {
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {
    HierarchyNode& node = hierarchy.nodes[i];
    for (std::uint32_t k = 0; k < node.count; ++k)
      node.box.extend(boxes[hierarchy.references[node.first + k]]);
    for (const HierarchyNode& child : hierarchy.children(node)) node.box.extend(child.box);
  }
}

constexpr std::uint64_t kBytesPerReference = 2 * (sizeof(LinkedNode) + sizeof(TreeNode));

}  // namespace

std::size_t count_things(const Hierarchy& hierarchy, std::uint32_t size) {
  const std::vector<bool> is_known = known_things(hierarchy, size);
  return static_cast<std::size_t>(std::count(is_known.begin(), is_known.end(), true));
}

std::optional<Hierarchy> fit_hierarchy(Hierarchy hierarchy, const PrimitiveSource& source,
                                       const BvhOptions& options, const BuildContext& context) {
  const std::vector<Aabb> boxes = bound_all(source, context);
  const std::vector<bool> is_known = known_things(hierarchy, boxes.size());
  std::vector<std::uint32_t> fresh;
  std::size_t gone = 0, known = 0;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    known += is_known[i], gone += is_known[i] && boxes[i].is_empty();
    if (!is_known[i] && !boxes[i].is_empty()) fresh.push_back(i);
  }
  if (fresh.empty() && gone == 0) {
    fit_boxes(hierarchy, boxes);
    return hierarchy;
  }
  if (fresh.size() + gone > known / kFewChanges) return std::nullopt;
  const std::uint64_t references = hierarchy.references.size() + fresh.size();
  context.require_memory(references * (kBytesPerReference + Collapse::bytes(2, options.arity)),
                         "bvh");
  LinkedTree tree = make_linked(hierarchy, boxes);
  for (const std::uint32_t i : fresh) insert_leaf(tree, i, boxes[i]);
  return finish_bvh_tree(make_tree(tree), options, context);
}

}  // namespace strahl
