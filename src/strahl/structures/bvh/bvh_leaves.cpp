#include <utility>

#include <strahl/build/linked_tree.h>
#include <strahl/structures/bvh/bvh_build.h>
#include <strahl/structures/bvh/bvh_leaves.h>

namespace strahl {

CollapseRules collapse_rules(const BvhOptions& options) {
  CollapseRules rules;
  rules.width = options.arity;
  rules.max_leaf = static_cast<std::size_t>(options.leaf_size);
  rules.node_cost = options.traverse_cost, rules.leaf_cost = 0.0;
  rules.primitive_cost = options.intersect_cost;
  return rules;
}

Hierarchy finish_bvh_tree(Tree tree, const BvhOptions& options, const BuildContext& context) {
  const SahCost cost{options.traverse_cost, options.intersect_cost};
  tree = limit_depth(std::move(tree), kBvhMaxDepth, cost, context);
  return make_hierarchy(tree, Collapse(tree, collapse_rules(options), context));
}

}  // namespace strahl
