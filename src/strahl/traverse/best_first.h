// traverse/best_first.h - the loop over trees that always goes on with the nearest subtree there
// is.
//
// Paper:      [KayKajiya1986]: a heap of subtrees by the entry of the ray. Subtrees that begin
//             beyond the best hit are not put in (Haines, Ray Tracing News 4).
// Invariants: entries never decrease from a node to its children, so a subtree is opened only if it
//             may hold a hit no farther than the one that is found in the end: every other order
//             opens these, too. A tie is never lost: entries are lowered by the hit margin.
// Differs from the paper: of equal entries the later node comes first, which is the deeper one.
// Thread safety: one heap per ray.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <strahl/traverse/walk.h>

namespace strahl {

/// A binary heap of visits, the nearest on top. Allocates only beyond kOwn visits.
class VisitHeap {
 public:
  static constexpr std::size_t kOwn = 256;

  std::size_t size() const { return grown_.empty() ? size_ : grown_.size(); }
  bool is_empty() const { return size() == 0; }
  void push(const NodeVisit& visit) {
    if (grown_.empty() && size_ < kOwn) {
      own_[size_++] = visit;
      std::push_heap(own_.begin(), own_.begin() + static_cast<std::ptrdiff_t>(size_), comes_later);
      return;
    }
    if (grown_.empty()) grown_.assign(own_.begin(), own_.end()), size_ = 0;
    grown_.push_back(visit);
    std::push_heap(grown_.begin(), grown_.end(), comes_later);
  }
  NodeVisit pop() {
    if (grown_.empty()) {
      std::pop_heap(own_.begin(), own_.begin() + static_cast<std::ptrdiff_t>(size_), comes_later);
      return own_[--size_];
    }
    std::pop_heap(grown_.begin(), grown_.end(), comes_later);
    const NodeVisit nearest = grown_.back();
    grown_.pop_back();
    return nearest;
  }

 private:
  static bool comes_later(const NodeVisit& a, const NodeVisit& b) {
    if (a.span.t_enter != b.span.t_enter) return a.span.t_enter > b.span.t_enter;
    return a.node < b.node;
  }

  std::array<NodeVisit, kOwn> own_;
  std::size_t size_ = 0;
  std::vector<NodeVisit> grown_;  ///< instead of own_ while it holds anything
};

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <WalkableTree Tree, class Prims, class Q, class C>
void walk_best_first(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query,
                     C& counters) {
  VisitHeap waiting;
  NodeVisit at = tree.enter(ray);
  counters.volume_tests(1);
  if (at.span.t_enter > at.span.t_exit) return;
  while (may_hit_before(at.span.t_enter, query.t_max())) {  // false: all others are farther
    if (visit_references(tree, at.node, prims, ray, query, counters)) return;
    if (!tree.is_leaf(at.node)) {
      counters.traversal_step();
      std::array<NodeVisit, Tree::kMaxChildren> child;
      const int entered = tree.expand(ray, at, child.data(), counters);
      for (int i = 0; i < entered; ++i) {
        const NodeVisit& next = child[static_cast<std::size_t>(i)];
        if (may_hit_before(next.span.t_enter, query.t_max())) waiting.push(next);
      }
      counters.waiting(waiting.size());
    }
    if (waiting.is_empty()) return;
    at = waiting.pop();
  }
}

}  // namespace strahl
