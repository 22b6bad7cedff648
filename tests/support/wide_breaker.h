// tests/support/wide_breaker.h - plants faults in a finished wide_bvh.
#pragma once

#include <cstddef>
#include <cstdint>

#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl {

/// Reaches into a finished tree.
class WideBvhBreaker {
 public:
  explicit WideBvhBreaker(WideBvh& bvh) : tree(bvh.tree_), report(bvh.report_) {}

  std::byte* at(WideId id) { return tree.at(id); }
  float* planes(WideId node, int row) {
    return reinterpret_cast<float*>(at(node)) + row * tree.width;
  }
  WideId* children(WideId node) { return reinterpret_cast<WideId*>(planes(node, 6)); }
  int used_slot(WideId node) {
    int slot = 0;
    while (!(planes(node, 0)[slot] <= planes(node, 3)[slot])) ++slot;
    return slot;
  }
  int empty_slot(WideId node) {
    int slot = 0;
    while (planes(node, 0)[slot] <= planes(node, 3)[slot]) ++slot;
    return slot;
  }
  /// Some block of at least two lanes.
  WideId block() { return find_block(tree.root); }
  float* corners(WideId leaf) { return reinterpret_cast<float*>(at(leaf) + sizeof(LeafBound)); }
  std::uint32_t* references(WideId leaf) {
    return reinterpret_cast<std::uint32_t*>(corners(leaf)) + 9 * lanes_of(leaf);
  }
  LeafBound& bound(WideId leaf) { return *reinterpret_cast<LeafBound*>(at(leaf)); }

  WideTree& tree;
  BuildReport& report;

 private:
  WideId find_block(WideId id) {
    if (is_leaf(id)) return lanes_of(id) >= 2 ? id : 0;
    for (int slot = 0; slot < tree.width; ++slot) {
      if (!(planes(id, 0)[slot] <= planes(id, 3)[slot])) continue;
      if (const WideId found = find_block(children(id)[slot])) return found;
    }
    return 0;
  }
};

}  // namespace strahl
