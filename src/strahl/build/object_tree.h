// build/object_tree.h - top-down division of primitives into a neutral binary tree.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/object_split.h>
#include <strahl/build/tree.h>

namespace strahl {

/// When to stop dividing.
struct LeafRules {
  SahCost cost;
  std::size_t max_leaf = 4;   ///< more primitives are divided even if a leaf seems cheaper
  int max_depth = 64;         ///< hard limit; near it sets are halved so that it holds
  std::size_t undivided = 1;  ///< so few are a leaf without asking what a division would cost
};

/// Divides all of the splitter's primitives. Deterministic for any executor. n > 0.
/// Throws Error{cancelled}.
Tree build_object_tree(ObjectSplitter& splitter, std::size_t primitives, const Aabb& box,
                       const LeafRules& rules, const BuildContext& context);

}  // namespace strahl
