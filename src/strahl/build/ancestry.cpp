#include <strahl/build/ancestry.h>

namespace strahl {

Ancestry::Ancestry(const Hierarchy& tree, std::size_t things)
    : parent_(tree.nodes.size(), kNone),
      first_leaf_(things, kNone),
      next_leaf_(tree.references.size(), kNone),
      leaf_(tree.references.size(), kNone) {
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const HierarchyNode& node = tree.nodes[i];
    for (std::uint32_t c = 0; c < node.children; ++c) parent_[node.first + c] = i;
    for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
      std::uint32_t& first = first_leaf_[tree.references[at]];
      leaf_[at] = i, next_leaf_[at] = first, first = at;
    }
  }
}

void Ancestry::mark(std::uint32_t thing, std::uint32_t mark,
                    std::vector<std::uint32_t>& owner) const {
  for (std::uint32_t at = first_leaf_[thing]; at != kNone; at = next_leaf_[at])
    for (std::uint32_t up = leaf_[at]; up != kNone && owner[up] != mark; up = parent_[up])
      owner[up] = mark;
}

}  // namespace strahl
