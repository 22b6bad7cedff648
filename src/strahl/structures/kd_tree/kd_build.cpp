#include <optional>
#include <utility>

#include <strahl/build/space_median.h>
#include <strahl/build/top_down.h>
#include <strahl/structures/kd_tree/kd_build.h>

namespace strahl {
namespace {

KdSweep sweep_of(KdSplit split) {
  if (split == KdSplit::sah_sort) return KdSweep::sort;
  return split == KdSplit::sah_naive ? KdSweep::count : KdSweep::splice;
}

std::size_t sweep_limit_of(const KdTreeOptions& options) {
  if (options.split == KdSplit::automatic) return kAutoSweepLimit;
  if (options.split != KdSplit::sah_binned) return kMaxSweepFragments;
  return static_cast<std::size_t>(options.bins);  // so few have no more ends than there are bins
}

KdRules rules_of(const KdTreeOptions& options, std::size_t primitives) {
  KdRules rules;
  rules.name = KdTree::kName;
  rules.cost = {options.traverse_cost, options.intersect_cost};
  rules.empty_bonus = options.empty_bonus;
  rules.sweep = sweep_of(options.split);
  rules.empty_cut = options.empty_cut;
  rules.walls = options.walls;
  rules.look_ahead = options.look_ahead;
  rules.clip = options.clip;
  rules.bins = options.bins;
  rules.sweep_limit = sweep_limit_of(options);
  rules.max_leaf = static_cast<std::size_t>(options.max_leaf);
  rules.max_depth = kd_depth_limit(options.max_depth, KdTree::kMaxDepth, primitives);
  rules.min_volume = options.min_volume;
  rules.cost_stop = options.cost_stop;
  rules.bad_splits = options.bad_splits;
  rules.retract = options.retract;
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
    const SplitPlane first = find_first_plane(work);
    if (first.is_found()) return first;
    const SplitPlane plane = find_plane(work, depth);
    if (!may_divide(work, plane)) return {};
    return plane;
  }

  std::size_t open(const Work& work, const SplitPlane& plane, Output& out) {
    return add_node(KdNode::inner(plane.axis, plane.position), work.fragments.size(), out);
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
    return looks_ahead() ? find_plane_ahead(work) : find_cheapest_plane(work);
  }

  /// The other axes are tried in turn where the first has no room or would divide nothing.
  template <class Find>
  SplitPlane find_on_some_axis(Find find, const Work& work, int depth) const {
    const PlaneCost cost = cost_in(work.cell);
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
                       const KdTreeOptions& options, const BuildContext& context,
                       BuildReport& report) {
  BinaryPolicy policy(source, options, context, refs.size());
  CellWork work = policy.make_root(refs, root);
  const std::size_t total = std::exchange(refs, {}).size();
  KdOutput tree;
  TopDown<BinaryPolicy>(policy, context, total).run(std::move(work), tree);
  return policy.finish(std::move(tree), root, report);
}

}  // namespace strahl
