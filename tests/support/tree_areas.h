// tests/support/tree_areas.h - what bottom-up trees are compared by: areas, whatever the numbering.
#pragma once

#include <algorithm>
#include <vector>

#include <strahl/build/linked_tree.h>

namespace strahl::test {

/// Half areas of all inner nodes, ascending.
inline std::vector<double> areas_of(const LinkedTree& tree) {
  std::vector<double> areas;
  for (const LinkedNode& node : tree.nodes)
    if (!node.is_leaf()) areas.push_back(node.box.half_area());
  std::sort(areas.begin(), areas.end());
  return areas;
}

}  // namespace strahl::test
