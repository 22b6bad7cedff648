// structures/bvh/bvh_leaves.h - a binary tree of single references made into what a bvh holds.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/collapse.h>
#include <strahl/build/hierarchy.h>
#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {

/// By the costs and sizes of the options.
CollapseRules collapse_rules(const BvhOptions& options);

/// The cheapest leaves and wide nodes that the options allow, no deeper than kBvhMaxDepth.
/// Throws Error{cancelled}.
Hierarchy finish_bvh_tree(Tree tree, const BvhOptions& options, const BuildContext& context);

}  // namespace strahl
