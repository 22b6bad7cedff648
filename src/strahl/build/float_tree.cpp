#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <strahl/base/large_pages.h>
#include <strahl/build/float_clusters.h>
#include <strahl/build/float_split.h>
#include <strahl/build/float_tree.h>
#include <strahl/build/sort_few.h>
#include <strahl/build/top_down.h>

namespace strahl {
namespace {

/// A set of primitives, or of clusters of them that will be opened into [first, first + count).
struct FloatWork {
  FloatSet set;
  std::uint32_t first = 0, count = 0;
  bool of_clusters = false;
  std::uint32_t spare = 0;  ///< free places behind the set
  int in_vain = 0;          ///< searches for a cut since the last one found
};

/// Division of a set: the cut where one was found.
struct FloatPlan {
  FloatSplit split;
  FloatCut cut;
};

/// Half the area of what two boxes have in common; none where they only touch.
float overlap(const FloatBox& a, const FloatBox& b) {
  const Float4 lo = a.lo > b.lo ? a.lo : b.lo;
  const Float4 minus_hi = a.minus_hi > b.minus_hi ? a.minus_hi : b.minus_hi;
  const FloatBox common{lo, minus_hi};
  const Float4 extent = common.extent(), thinner = min4(a.extent(), b.extent());
  for (int axis = 0; axis < 3; ++axis)
    if (extent[axis] < 0.0f || (extent[axis] == 0.0f && thinner[axis] > 0.0f)) return 0.0f;
  return half_area(common);
}

/// Whether and where to cut.
struct FloatCuts {
  FloatCutter cutter;
  FloatCutRules rules;
  float root_area;

  /// Infinite cost where dividing is as good.
  FloatCut find(FloatWork& work, const FloatSplit& split) const {
    FloatCut none;
    if (work.spare == 0 || work.count < rules.least || work.in_vain >= rules.patience) return none;
    if (split.is_found() && !(overlap(split.left, split.right) > rules.least_overlap * root_area))
      return none;
    const FloatCut cut = cutter.find(work.set, work.spare);
    const bool is_better = cut.cost < split.cost;
    work.in_vain = is_better ? 0 : work.in_vain + 1;
    return is_better ? cut : none;
  }
};

/// Free places for the left one of two sides.
std::uint32_t left_share(std::uint32_t spare, std::uint32_t left_count, const FloatBox& left,
                         std::uint32_t right_count, const FloatBox& right) {
  const float l = static_cast<float>(left_count) * std::sqrt(half_area(left));
  const float r = static_cast<float>(right_count) * std::sqrt(half_area(right));
  const float part = l / (l + r);
  if (!(part >= 0.0f)) return spare / 2;
  return std::min(spare, static_cast<std::uint32_t>(static_cast<float>(spare) * part));
}

class FloatPolicy {
 public:
  using Work = FloatWork;
  using Output = Tree;

  FloatPolicy(const FloatSplitter& splitter, std::span<FloatRef> refs, const FloatTreeRules& rules)
      : splitter_(splitter), refs_(refs), rules_(rules) {}

  /// From here on there are clusters.
  void set_clusters(const FloatSplitter& clusters, const FloatRef* sorted) {
    clusters_ = &clusters, sorted_ = sorted;
  }

  /// From here on things may be cut.
  void set_cuts(const FloatCuts& cuts) { cuts_ = &cuts; }

  /// A split that is not found stands for halving.
  std::optional<FloatPlan> plan(FloatWork& work, int depth) const {
    if (work.count <= rules_.undivided) return open_if_closed(work), std::nullopt;
    // Halving from here on ends in single primitives within the levels that are left.
    const int levels_left = rules_.max_depth - depth;
    // What cuts may add must find its levels, too.
    if (static_cast<int>(std::bit_width(work.count + work.spare - 1)) >= levels_left)
      return open_if_closed(work), FloatPlan();
    if (work.of_clusters && work.count > rules_.opened && work.set.size() > 1) {
      const FloatSplit split = clusters_->find(work.set);
      if (split.is_found()) return FloatPlan{split, FloatCut()};
    }
    open_if_closed(work);
    const FloatSplit split = splitter_.find(work.set);
    return FloatPlan{split, cuts_ != nullptr ? cuts_->find(work, split) : FloatCut()};
  }

  void leaf(const FloatWork& work, Tree& out) const {
    const auto first = static_cast<std::uint32_t>(out.references.size());
    out.nodes.push_back({work.set.box.box(), 0, first, work.count, 0});
    for (const FloatRef& ref : splitter_.refs_of(work.set)) out.references.push_back(ref.reference);
    sort_few(std::span(out.references).subspan(first));
  }

  std::size_t open(const FloatWork& work, const FloatPlan& plan, Tree& out) const {
    const int axis = plan.cut.is_found() ? plan.cut.axis : plan.split.axis;
    out.nodes.push_back({work.set.box.box(), 0, 0, 0, static_cast<std::uint32_t>(axis)});
    return out.nodes.size() - 1;
  }

  std::pair<FloatWork, FloatWork> divide(const FloatWork& work, const FloatPlan& plan) const {
    if (work.of_clusters) return divide_clusters(work, plan.split);
    return plan.cut.is_found() ? cut(work, plan.cut) : divide_things(work, plan.split);
  }

  void link(Tree& out, std::size_t inner) const {
    out.nodes[inner].right = static_cast<std::uint32_t>(out.nodes.size());
  }
  void append(Tree& out, const Tree& part) const { out.append(part); }
  std::size_t weight(const FloatWork& work) const { return work.count; }
  Tree make_output() const { return {}; }

 private:
  static FloatWork opened(const FloatSet& set, std::uint32_t end, int in_vain) {
    return {set, set.begin, static_cast<std::uint32_t>(set.size()), false, end - set.end, in_vain};
  }

  /// Free places for the left side. None where no side is searched for a cut any more.
  std::uint32_t gap_of(const FloatWork& work, const FloatSplit& split) const {
    if (work.spare == 0 || work.count < cuts_->rules.least) return 0;
    if (!split.is_found()) return work.spare / 2;
    return left_share(work.spare, split.left_count, split.left, work.count - split.left_count,
                      split.right);
  }

  std::pair<FloatWork, FloatWork> divide_things(const FloatWork& work,
                                                const FloatSplit& split) const {
    const std::uint32_t gap = gap_of(work, split);
    const auto [left, right] =
        split.is_found() ? splitter_.divide(work.set, split, gap) : splitter_.halve(work.set, gap);
    return {opened(left, right.begin, work.in_vain),
            opened(right, work.set.end + work.spare, work.in_vain)};
  }

  /// Fewer references than planned, where some stay whole, leave more places to the sides.
  std::pair<FloatWork, FloatWork> cut(const FloatWork& work, const FloatCut& cut) const {
    const std::uint32_t spare = work.count + work.spare - cut.left - cut.right;
    const std::uint32_t right_begin =
        work.set.begin + cut.left +
        left_share(spare, cut.left, cut.left_box, cut.right, cut.right_box);
    const auto [left, right] = cuts_->cutter.divide(work.set, cut, right_begin);
    return {opened(left, right_begin, work.in_vain),
            opened(right, work.set.end + work.spare, work.in_vain)};
  }

  std::pair<FloatWork, FloatWork> divide_clusters(const FloatWork& work,
                                                  const FloatSplit& split) const {
    const auto [left, right] = clusters_->divide(work.set, split);
    return {{left, work.first, split.left_weight, true},
            {right, work.first + split.left_weight, work.count - split.left_weight, true}};
  }

  void open_if_closed(FloatWork& work) const {
    if (!work.of_clusters) return;
    FloatRef* to = refs_.data() + work.first;
    for (const FloatRef& cluster : clusters_->refs_of(work.set))
      to = std::copy_n(sorted_ + cluster.reference, cluster.weight, to);
    work.set = splitter_.bounded(work.first, work.first + work.count);
    work.of_clusters = false;
  }

  const FloatSplitter& splitter_;
  std::span<FloatRef> refs_;
  const FloatTreeRules& rules_;
  const FloatCuts* cuts_ = nullptr;
  const FloatSplitter* clusters_ = nullptr;
  const FloatRef* sorted_ = nullptr;
};

/// Divides clusters first.
void divide_clusters(FloatPolicy& policy, TopDown<FloatPolicy>& loop, std::span<FloatRef> refs,
                     const FloatSet& whole, const FloatTreeRules& rules,
                     const BuildContext& context, Tree& tree) {
  FloatClusters made = make_clusters(refs, whole.centers, rules.cluster, context);
  std::vector<FloatRef> copies(made.clusters.size());
  const FloatSplitter splitter(made.clusters, copies, FloatSplitter::kMaxBins, true);
  policy.set_clusters(splitter, made.sorted.get());
  const FloatSet all = splitter.bounded(0, static_cast<std::uint32_t>(made.clusters.size()));
  loop.run({all, 0, static_cast<std::uint32_t>(refs.size()), true}, tree);
}

Tree tree_with_room(std::size_t references, const FloatTreeRules& rules) {
  Tree tree;
  tree.references.reserve(references);
  tree.nodes.reserve(4 * references / (rules.undivided + 1) + 1);
  prefer_large_pages(tree.nodes.data(), tree.nodes.capacity() * sizeof(TreeNode));
  return tree;
}

}  // namespace

std::uint64_t float_tree_bytes(const FloatTreeRules& rules) {
  return sizeof(FloatRef) + (rules.cluster > 0 ? kClusterBytes : 0);
}

Tree build_cut_float_tree(std::span<FloatRef> room, std::size_t count, const FloatTreeRules& rules,
                          const FloatCutRules& cuts, const FloatThings& things,
                          const BuildContext& context) {
  const auto copies = std::make_unique_for_overwrite<FloatRef[]>(room.size());
  prefer_large_pages(copies.get(), room.size() * sizeof(FloatRef));
  const FloatSplitter splitter(room, {copies.get(), room.size()}, rules.bins, false);
  Tree tree = tree_with_room(room.size(), rules);
  FloatPolicy policy(splitter, room, rules);
  const auto used = static_cast<std::uint32_t>(count);
  const FloatSet whole = splitter.bounded(0, used);
  const FloatCuts all_cuts{FloatCutter(splitter, things, cuts.bins), cuts, half_area(whole.box)};
  policy.set_cuts(all_cuts);
  const auto spare = static_cast<std::uint32_t>(room.size() - count);
  TopDown<FloatPolicy>(policy, context, room.size()).run({whole, 0, used, false, spare}, tree);
  return tree;
}

Tree build_float_tree(std::span<FloatRef> refs, const FloatTreeRules& rules,
                      const BuildContext& context) {
  const auto count = static_cast<std::uint32_t>(refs.size());
  const auto copies = std::make_unique_for_overwrite<FloatRef[]>(count);
  prefer_large_pages(copies.get(), count * sizeof(FloatRef));
  const FloatSplitter splitter(refs, {copies.get(), count}, rules.bins, false);
  Tree tree = tree_with_room(count, rules);
  FloatPolicy policy(splitter, refs, rules);
  TopDown<FloatPolicy> loop(policy, context, count);
  const FloatSet whole = splitter.bounded(0, count);
  if (rules.cluster > 0 && count > 2 * rules.opened)
    divide_clusters(policy, loop, refs, whole, rules, context, tree);
  else
    loop.run({whole, 0, count, false}, tree);
  return tree;
}

}  // namespace strahl
