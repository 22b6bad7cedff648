#include <optional>
#include <utility>

#include <strahl/build/space_median.h>
#include <strahl/build/top_down.h>
#include <strahl/structures/kd_tree/kd_build.h>

namespace strahl {
namespace {

KdRules rules_of(const KdTreeOptions& options, std::size_t primitives) {
  KdRules rules;
  rules.name = KdTree::kName;
  rules.cost = {options.traverse_cost, options.intersect_cost};
  rules.empty_bonus = options.empty_bonus;
  rules.clip = options.clip;
  rules.bins = options.bins;
  if (options.split == KdSplit::sah_sweep) rules.sweep_limit = kMaxSweepFragments;
  if (options.split == KdSplit::sah_binned)  // so few have no more ends than there are bins
    rules.sweep_limit = static_cast<std::size_t>(options.bins);
  rules.max_leaf = static_cast<std::size_t>(options.max_leaf);
  rules.max_depth = kd_depth_limit(options.max_depth, KdTree::kMaxDepth, primitives);
  rules.bad_splits = options.bad_splits;
  rules.max_growth = options.max_growth;
  return rules;
}

class BinaryPolicy : public KdPolicy {
 public:
  using Work = CellWork;

  BinaryPolicy(const PrimitiveSource& source, const KdTreeOptions& options,
               const BuildContext& context, std::size_t primitives)
      : KdPolicy(source, rules_of(options, primitives), context, primitives), options_(options) {}

  std::optional<SplitPlane> plan(Work& work, int depth) {
    if (must_be_leaf(work, depth)) return {};
    const SplitPlane plane = find_plane(work, depth);
    if (!may_divide(work, plane)) return {};
    return plane;
  }

  std::size_t open(const Work&, const SplitPlane& plane, Output& out) {
    return add_node(KdNode::inner(plane.axis, plane.position), out);
  }

  std::pair<Work, Work> divide(Work&& work, const SplitPlane& plane) {
    return divide_at(std::move(work), plane);
  }

 private:
  SplitPlane find_plane(Work& work, int depth) {
    if (options_.split == KdSplit::middle)
      return find_on_some_axis(find_plane_at_middle, work, depth);
    if (options_.split == KdSplit::median)
      return find_on_some_axis(find_plane_at_median, work, depth);
    return find_cheapest_plane(work);
  }

  /// The other axes are tried in turn where the first has no room or would divide nothing.
  template <class Find>
  SplitPlane find_on_some_axis(Find find, const Work& work, int depth) const {
    const PlaneCost cost(work.cell, sah(), empty_bonus());
    const int first = options_.axis == KdAxis::longest ? work.cell.longest_axis() : depth;
    SplitPlane plane;
    for (int i = 0; i < 3 && !plane.is_found(); ++i)
      plane = find(work.fragments, cost, static_cast<std::size_t>((first + i) % 3));
    return plane;
  }

  const KdTreeOptions& options_;
};

}  // namespace

KdArrays build_kd_tree(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& root,
                       const KdTreeOptions& options, const BuildContext& context) {
  BinaryPolicy policy(source, options, context, refs.size());
  CellWork work = policy.make_root(refs, root);
  const std::size_t total = std::exchange(refs, {}).size();
  KdArrays tree;
  TopDown<BinaryPolicy>(policy, context, total).run(std::move(work), tree);
  tree.nodes.shrink_to_fit();
  tree.references.shrink_to_fit();
  return tree;
}

}  // namespace strahl
