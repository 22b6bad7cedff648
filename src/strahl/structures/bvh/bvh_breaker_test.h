// structures/bvh/bvh_breaker_test.h - lets tests plant faults in a finished hierarchy.
#pragma once

#include <strahl/structures/bvh/bvh.h>

namespace strahl {

class BvhBreaker {
 public:
  template <class V>
  static BvhTree<V>& tree(Bvh& bvh) {
    return dynamic_cast<BvhTree<V>&>(*bvh.tree_);
  }
  template <class V>
  static std::vector<BvhNode<V>>& nodes(BvhTree<V>& tree) {
    return tree.nodes_;
  }
  template <class V>
  static std::vector<std::uint32_t>& references(BvhTree<V>& tree) {
    return tree.references_;
  }
  template <class V>
  static BuildReport& report(BvhTree<V>& tree) {
    return tree.report_;
  }
  template <class V>
  static SahCost& cost(BvhTree<V>& tree) {
    return tree.cost_;
  }
};

}  // namespace strahl
