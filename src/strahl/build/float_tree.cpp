#include <algorithm>
#include <bit>
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
};

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

  /// A split that is not found stands for halving.
  std::optional<FloatSplit> plan(FloatWork& work, int depth) const {
    if (work.count <= rules_.undivided) return open_if_closed(work), std::nullopt;
    // Halving from here on ends in single primitives within the levels that are left.
    const int levels_left = rules_.max_depth - depth;
    if (static_cast<int>(std::bit_width(work.count - 1)) >= levels_left)
      return open_if_closed(work), FloatSplit{};
    if (work.of_clusters && work.count > rules_.opened && work.set.size() > 1) {
      const FloatSplit split = clusters_->find(work.set);
      if (split.is_found()) return split;
    }
    open_if_closed(work);
    return splitter_.find(work.set);
  }

  void leaf(const FloatWork& work, Tree& out) const {
    const auto first = static_cast<std::uint32_t>(out.references.size());
    out.nodes.push_back({work.set.box.box(), 0, first, work.count, 0});
    for (const FloatRef& ref : splitter_.refs_of(work.set)) out.references.push_back(ref.reference);
    sort_few(std::span(out.references).subspan(first));
  }

  std::size_t open(const FloatWork& work, const FloatSplit& split, Tree& out) const {
    out.nodes.push_back({work.set.box.box(), 0, 0, 0, static_cast<std::uint32_t>(split.axis)});
    return out.nodes.size() - 1;
  }

  std::pair<FloatWork, FloatWork> divide(const FloatWork& work, const FloatSplit& split) const {
    const FloatSplitter& splitter = work.of_clusters ? *clusters_ : splitter_;
    const auto [left, right] =
        split.is_found() ? splitter.divide(work.set, split) : splitter.halve(work.set);
    const auto left_count =
        work.of_clusters ? split.left_weight : static_cast<std::uint32_t>(left.size());
    return {{left, work.first, left_count, work.of_clusters},
            {right, work.first + left_count, work.count - left_count, work.of_clusters}};
  }

  void link(Tree& out, std::size_t inner) const {
    out.nodes[inner].right = static_cast<std::uint32_t>(out.nodes.size());
  }
  void append(Tree& out, const Tree& part) const { out.append(part); }
  std::size_t weight(const FloatWork& work) const { return work.count; }
  Tree make_output() const { return {}; }

 private:
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

}  // namespace

std::uint64_t float_tree_bytes(const FloatTreeRules& rules) {
  return sizeof(FloatRef) + (rules.cluster > 0 ? kClusterBytes : 0);
}

Tree build_float_tree(std::span<FloatRef> refs, const FloatTreeRules& rules,
                      const BuildContext& context) {
  const auto count = static_cast<std::uint32_t>(refs.size());
  const auto copies = std::make_unique_for_overwrite<FloatRef[]>(count);
  prefer_large_pages(copies.get(), count * sizeof(FloatRef));
  const FloatSplitter splitter(refs, {copies.get(), count}, rules.bins, false);
  Tree tree;
  tree.references.reserve(count);
  tree.nodes.reserve(4 * refs.size() / (rules.undivided + 1) + 1);
  prefer_large_pages(tree.nodes.data(), tree.nodes.capacity() * sizeof(TreeNode));
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
