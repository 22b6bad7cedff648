// build/kd_retract.h - subtrees that do not pay become leaves when the tree is finished.
//
// Source: mitsuba's "retract bad splits" [Jakob2010]: splits are made in the hope of better ones
//   behind them; where the finished subtree is expected to cost no less than a leaf, it is one.
// Invariant: no inner node costs as much as a leaf of its fragments; the expected cost of the tree
//   never grows.
#pragma once

#include <strahl/build/kd_policy.h>

namespace strahl {

/// Requires: tree.counts; no filters. O(nodes + references log references of those that move).
void retract_kd_tree(KdOutput& tree, const Aabb& root, const SahCost& cost);

}  // namespace strahl
