// structures/bih/bih.h - bounding interval hierarchy: primitives divided, two planes per node.
//
// Paper:      [Ooi1987] (spatial kd-tree), [Waechter2006]; planes of free orientation after
//             [Eisemann2008].
// Layout:     12-byte nodes (bih_node.h), siblings adjacent; boxes are implicit: the root's box cut
//             by the planes on the way down. Planes are floats rounded outward; references ascend
//             inside each leaf.
// Invariants: every primitive that can be hit is in exactly one leaf and inside the implicit box of
//             every node above it; at most kMaxDepth nodes with two children on a path.
// Differs from the papers: nodes are trimmed along any axis, at inner nodes of any split; planes
// are
//             tested in double with the margins of math/margin.h.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/box_tree.h>
#include <strahl/build/build_report.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/bih/bih_node.h>
#include <strahl/traverse/walk.h>

namespace strahl {

enum class BihSplit { sah, sah_sweep, global };
enum class BihPlanes { parallel, free };

/// README.md shows how trim was chosen; the defaults that bvh has, too, are the same.
struct BihOptions {
  BihSplit split = BihSplit::sah;
  BihPlanes planes = BihPlanes::parallel;
  double trim = 0.75;
  int bins = 32;
  int leaf_size = 4;
  double traverse_cost = 1.0;
  double intersect_cost = 1.0;
};

OptionTable<BihOptions> option_fields(const BihOptions*);

/// O(log n) expected per ray where few boxes overlap. 12 bytes per node, 4 per reference.
/// Throws Error{resource} above the memory limit or beyond 2^26 nodes.
class Bih {
 public:
  using Options = BihOptions;
  static constexpr const char* kName = "bih";
  static constexpr const char* kTitle = "bounding interval hierarchy: two planes per node";
  static constexpr bool kRefersOnce = true;
  static constexpr int kMaxChildren = 2;
  static constexpr int kMaxDepth = 64;

  Bih(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (!tree_.nodes.empty()) walk(*this, prims, ray, query, counters);
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;
  /// With the implicit boxes. O(nodes).
  BoxTree box_tree() const;

  // What walk() asks for.
  NodeVisit enter(const PreparedRay& ray) const {
    return {0, clip_to_box(ray, root_box_.lo, root_box_.hi, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t node) const { return tree_.nodes[node].is_leaf(); }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return {tree_.references.data() + tree_.nodes[node].first(), tree_.nodes[node].count()};
  }
  /// The child whose interval has the earlier middle comes first; for parallel planes that is the
  /// one on the side the ray comes from.
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* child, C&) const {
    const BihNode& node = tree_.nodes[at.node];
    if (node.is_trimmed()) {
      const int axis = node.trimmed_axis();
      const Interval above = clip_to_side(ray, axis, true, node.plane(0), at.span);
      child[0] = {node.child(), clip_to_side(ray, axis, false, node.plane(1), above)};
      return child[0].span.t_enter <= child[0].span.t_exit;
    }
    child[0] = {node.child(), clip(ray, node.side(0), at.span)};
    child[1] = {node.child() + 1, clip(ray, node.side(1), at.span)};
    const Interval &left = child[0].span, &right = child[1].span;
    const bool enters_left = left.t_enter <= left.t_exit;
    const bool enters_right = right.t_enter <= right.t_exit;
    if (enters_left && enters_right) {
      if (right.t_enter + right.t_exit < left.t_enter + left.t_exit) std::swap(child[0], child[1]);
      return 2;
    }
    if (enters_right) child[0] = child[1];
    return enters_left || enters_right;
  }

 private:
  static Interval clip(const PreparedRay& ray, const AxisSide& side, const Interval& span) {
    return clip_to_side(ray, side.axis, side.is_above, side.plane, span);
  }

  BihArrays tree_;
  Aabb root_box_;
  BuildReport report_;
  double reference_cost_;  ///< of a test, a node step being 1
};

}  // namespace strahl
