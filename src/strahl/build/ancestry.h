// build/ancestry.h - which nodes of a hierarchy are above a thing that it refers to.
//
// Layout: the parent of each node; the places of a thing among the references, as a list.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/build/hierarchy.h>

namespace strahl {

class Ancestry {
 public:
  /// @param things above all references
  Ancestry(const Hierarchy& tree, std::size_t things);

  bool holds(std::uint32_t thing) const {
    return thing < first_leaf_.size() && first_leaf_[thing] != kNone;
  }
  /// owner[node] = mark for all nodes above the thing. O(leaves it is in * depth).
  void mark(std::uint32_t thing, std::uint32_t mark, std::vector<std::uint32_t>& owner) const;

 private:
  static constexpr std::uint32_t kNone = ~0u;

  std::vector<std::uint32_t> parent_, first_leaf_, next_leaf_, leaf_;
};

}  // namespace strahl
