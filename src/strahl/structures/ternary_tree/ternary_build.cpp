#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include <strahl/build/top_down.h>
#include <strahl/structures/ternary_tree/oversize.h>
#include <strahl/structures/ternary_tree/ternary_build.h>

namespace strahl {
namespace {

KdRules rules_of(const TernaryTreeOptions& options, std::size_t primitives) {
  KdRules rules;
  rules.name = TernaryTree::kName;
  rules.cost = {options.traverse_cost, options.intersect_cost};
  rules.clip = options.clip;
  rules.bins = options.bins;
  if (options.split == TernarySplit::sah_sweep) rules.sweep_limit = kMaxSweepFragments;
  if (options.split == TernarySplit::sah_binned)
    rules.sweep_limit = static_cast<std::size_t>(options.bins);
  rules.max_depth = kd_depth_limit(options.max_depth, TernaryTree::kMaxDepth, primitives);
  rules.max_growth = options.max_growth;
  return rules;
}

/// A cell, and what plan() has found out about it.
struct TernaryWork : CellWork {
  TernaryWork() = default;
  TernaryWork(CellWork&& work, bool filters) : CellWork(std::move(work)), may_filter(filters) {}

  bool may_filter = true;
  bool is_list = false;               ///< stays whole
  std::optional<SplitPlane> planned;  ///< found when the oversized were taken out
  std::unique_ptr<std::pair<TernaryWork, TernaryWork>> filtered;  ///< oversized, rest
};

/// Empty: the parts are in TernaryWork::filtered.
using TernaryPlan = std::optional<SplitPlane>;

class TernaryPolicy : public KdPolicy {
 public:
  using Work = TernaryWork;

  TernaryPolicy(const PrimitiveSource& source, const TernaryTreeOptions& options,
                const BuildContext& context, std::size_t primitives)
      : KdPolicy(source, rules_of(options, primitives), context, primitives),
        options_(options),
        max_depth_(kd_depth_limit(options.max_depth, TernaryTree::kMaxDepth, primitives)) {}

  std::optional<TernaryPlan> plan(Work& work, int depth) {
    if (work.planned) return work.planned;
    if (work.is_list || must_be_leaf(work, depth)) return {};
    const bool tries = work.may_filter && depth + 1 < max_depth_ && take_out_oversized(work);
    if (tries && options_.decide == OversizeDecision::always) return TernaryPlan{};
    const SplitPlane plane = find_cheapest_plane(work);
    if (tries && cost_filtered(work) < plane.cost) return TernaryPlan{};
    work.filtered.reset();
    if (!may_divide(work, plane)) return {};
    return TernaryPlan{plane};
  }

  std::size_t open(const Work& work, const TernaryPlan& plan, Output& out) {
    return add_node(plan ? KdNode::inner(plan->axis, plan->position) : KdNode::filter(),
                    work.fragments.size(), out);
  }

  std::pair<Work, Work> divide(Work&& given, const TernaryPlan& plan) {
    if (!plan) {
      const Work work = std::move(given);
      return std::move(*work.filtered);
    }
    const bool filters = given.may_filter;
    auto halves = divide_at(std::move(given), *plan);
    return {Work(std::move(halves.first), filters), Work(std::move(halves.second), filters)};
  }

 private:
  /// Fills work.filtered; false when nothing or all is oversized or the rest should stay whole.
  bool take_out_oversized(Work& work) {
    const std::vector<bool> is_oversized = find_oversized(work.fragments, work.cell, options_);
    const auto count =
        static_cast<std::size_t>(std::count(is_oversized.begin(), is_oversized.end(), true));
    if (count == 0 || count == work.fragments.size()) return false;
    auto parts = divide_by(work, is_oversized);
    Work oversized(std::move(parts.first), false), rest(std::move(parts.second), true);
    const SplitPlane plane = find_cheapest_plane(rest);
    if (!may_divide(rest, plane)) return false;
    rest.planned = plane;
    oversized.is_list = options_.keep == OversizeKeep::list ||
                        (options_.keep == OversizeKeep::automatic &&
                         count <= static_cast<std::size_t>(options_.list_max));
    work.filtered = std::make_unique<std::pair<Work, Work>>(std::move(oversized), std::move(rest));
    return true;
  }

  /// Expected in one level: the oversized primitives and the plane through the rest.
  double cost_filtered(Work& work) {
    auto& [oversized, rest] = *work.filtered;
    const double listed = sah_leaf_cost(sah(), oversized.fragments.size());
    const double cost =
        oversized.is_list ? listed : std::min(listed, find_cheapest_plane(oversized).cost);
    return cost + rest.planned->cost;
  }

  const TernaryTreeOptions& options_;
  int max_depth_;
};

}  // namespace

KdArrays build_ternary_tree(const PrimitiveSource& source, std::vector<PrimRef> refs,
                            const Aabb& root, const TernaryTreeOptions& options,
                            const BuildContext& context, BuildReport& report) {
  TernaryPolicy policy(source, options, context, refs.size());
  TernaryWork work(policy.make_root(refs, root), true);
  const std::size_t total = std::exchange(refs, {}).size();
  KdOutput tree;
  TopDown<TernaryPolicy>(policy, context, total).run(std::move(work), tree);
  return policy.finish(std::move(tree), root, report);
}

}  // namespace strahl
