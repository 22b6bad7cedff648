// traverse/leaf_query.h - a query with all it tests behind one call per leaf.
//
// Loops over rare kinds of trees are compiled once with it, instead of once per query, kind of
// primitive and structure: only leaves are virtual calls, nodes are not.
// Thread safety: one per ray.
#pragma once

#include <strahl/traverse/leaf.h>

namespace strahl {

/// Stands for both the primitives and the query in the loops of traverse/.
class LeafQuery {
 public:
  double t_max() const { return t_max_; }
  /// Tests what a leaf refers to. True when the query stops the traversal.
  virtual bool test(std::span<const std::uint32_t> references) = 0;

 protected:
  explicit LeafQuery(double t_max) : t_max_(t_max) {}
  ~LeafQuery() = default;
  double t_max_;
};

/// All of it must outlive the object.
template <class Prims, class Q, class C>
class LeafQueryOf final : public LeafQuery {
 public:
  LeafQueryOf(Prims& prims, const PreparedRay& ray, Q& query, C& counters)
      : LeafQuery(query.t_max()), prims_(prims), ray_(ray), query_(query), counters_(counters) {}

  bool test(std::span<const std::uint32_t> references) override {
    const bool stops = test_references(references, prims_, ray_, query_, counters_);
    t_max_ = query_.t_max();
    return stops;
  }

 private:
  Prims& prims_;
  const PreparedRay& ray_;
  Q& query_;
  C& counters_;
};

/// What the loops call in a leaf: preferred to the general one.
template <class C>
bool test_leaf(std::span<const std::uint32_t> references, LeafQuery& leaves, const PreparedRay&,
               LeafQuery&, C& counters) {
  counters.leaf_entered(references.empty());
  return leaves.test(references);
}

}  // namespace strahl
