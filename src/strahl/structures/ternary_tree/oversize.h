// structures/ternary_tree/oversize.h - which fragments of a cell are oversized.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include <strahl/build/fragment.h>
#include <strahl/structures/ternary_tree/ternary_tree.h>

namespace strahl {

/// One flag per fragment, by the rule and threshold of the options. O(n).
std::vector<bool> find_oversized(std::span<const Fragment> fragments, const Aabb& cell,
                                 const TernaryTreeOptions& options);

}  // namespace strahl
