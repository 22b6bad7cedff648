#include <algorithm>
#include <atomic>
#include <bit>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/build/memory_meter.h>
#include <strahl/build/space_bins.h>
#include <strahl/build/space_median.h>
#include <strahl/build/space_sweep.h>
#include <strahl/build/top_down.h>
#include <strahl/structures/kd_tree/kd_build.h>

namespace strahl {
namespace {

/// With split=auto, nodes with more fragments are divided at bins, smaller ones exactly.
constexpr std::size_t kAutoSweepLimit = 500'000;
/// Smaller leaves cost too little to hope for good splits behind a bad one.
constexpr std::size_t kWorthABadSplit = 16;
/// Nodes at least this large ask whether to go on before they are divided.
constexpr std::size_t kCheckEvery = 1u << 14;

/// A cell and the fragments in it.
struct CellWork {
  Aabb cell;
  std::vector<Fragment> fragments;
  SweepLists events;
  bool has_events = false;
  int bad_splits = 0;  ///< splits on the way here that cost more than a leaf
  double spare = 0.0;  ///< references that planes may still add below this cell
  MemoryLease lease;
};

class KdPolicy {
 public:
  using Work = CellWork;
  using Output = KdArrays;

  KdPolicy(const PrimitiveSource& source, const KdTreeOptions& options, const BuildContext& context,
           std::size_t primitives)
      : options_(options),
        context_(context),
        rules_{options.clip ? &source : nullptr, false},
        cost_{options.traverse_cost, options.intersect_cost},
        max_depth_(kd_depth_limit(options, primitives)),
        sweep_limit_(sweep_limit(options)),
        total_(primitives),
        meter_(context, "kd_tree") {}

  Work make_root(std::span<const PrimRef> refs, const Aabb& box) {
    Work work;
    work.lease = MemoryLease(meter_, refs.size() * (sizeof(PrimRef) + sizeof(Fragment)));
    work.cell = box;
    work.fragments = make_fragments(refs);
    work.spare = (options_.max_growth - 1.0) * static_cast<double>(refs.size());
    return work;
  }

  std::optional<SplitPlane> plan(Work& work, int depth) {
    const std::size_t count = work.fragments.size();
    if (count >= kCheckEvery) check_progress();
    if (count <= static_cast<std::size_t>(options_.max_leaf) || depth >= max_depth_) return {};
    const SplitPlane plane = find_plane(work, depth);
    if (!plane.is_found()) return {};
    if (plane.cost >= sah_leaf_cost(cost_, count) && !may_split_badly(work, plane)) return {};
    if (static_cast<double>(added_by(plane, count)) > work.spare) return {};
    return plane;
  }

  std::size_t open(const Work&, const SplitPlane& plane, Output& out) {
    return add_node(KdNode::inner(plane.axis, plane.position), out);
  }

  std::pair<Work, Work> divide(Work&& given, const SplitPlane& plane) {
    const Work work = std::move(given);  // freed when its halves are made
    DivideRules rules = rules_;
    rules.wants_places = work.has_events;
    const std::size_t halves_count = plane.left_count + plane.right_count;
    const MemoryLease places(meter_, work.has_events ? 8 * work.fragments.size() : 0);
    const MemoryLease growing(meter_, halves_count * sizeof(Fragment));
    FragmentHalves halves = divide_fragments(work.fragments, work.cell, plane, rules);
    std::pair<Work, Work> both{make_half(work, below(work.cell, plane), std::move(halves.left)),
                               make_half(work, above(work.cell, plane), std::move(halves.right))};
    const double spare = work.spare - static_cast<double>(added_by(plane, work.fragments.size()));
    const double left_share =
        static_cast<double>(plane.left_count) / static_cast<double>(halves_count);
    both.first.spare = spare * left_share;
    both.second.spare = spare * (1.0 - left_share);
    return both;
  }

  void leaf(Work&& given, Output& out) {
    const Work work = std::move(given);
    std::vector<std::uint32_t> references(work.fragments.size());
    std::transform(work.fragments.begin(), work.fragments.end(), references.begin(),
                   [](const Fragment& f) { return f.reference; });
    std::sort(references.begin(), references.end());
    const std::size_t count = references.size();
    if (count > KdNode::kMaxIndex || out.references.size() + count > kMaxReferences) refuse_size();
    const auto first = static_cast<std::uint32_t>(out.references.size());
    add_node(KdNode::leaf(count == 0 ? 0 : count == 1 ? references.front() : first, count), out);
    placed_.fetch_add(count, std::memory_order_relaxed);
    if (count < 2) return;
    meter_.take(count * kGrowth * sizeof(std::uint32_t));
    out.references.insert(out.references.end(), references.begin(), references.end());
  }

  void link(Output& out, std::size_t inner) { out.nodes[inner].link_right(out.nodes.size()); }

  void append(Output& out, Output&& right) {
    const std::size_t nodes = out.nodes.size(), references = out.references.size();
    if (nodes + right.nodes.size() > KdNode::kMaxIndex ||
        references + right.references.size() > kMaxReferences)
      refuse_size();
    for (KdNode& node : right.nodes) {
      if (!node.is_leaf())
        node.link_right(node.right() + nodes);
      else if (node.count() > 1)
        node.move_first(references);
    }
    out.nodes.insert(out.nodes.end(), right.nodes.begin(), right.nodes.end());
    out.references.insert(out.references.end(), right.references.begin(), right.references.end());
  }

  std::size_t weight(const Work& work) const { return work.fragments.size(); }
  Output make_output() const { return {}; }

 private:
  static constexpr std::size_t kMaxReferences = std::numeric_limits<std::uint32_t>::max();
  /// Growing arrays own up to twice what they hold.
  static constexpr std::size_t kGrowth = 2;

  static std::size_t sweep_limit(const KdTreeOptions& options) {
    if (options.split == KdSplit::sah_sweep) return kMaxSweepFragments;
    if (options.split == KdSplit::automatic) return kAutoSweepLimit;
    return static_cast<std::size_t>(options.bins);  // so few have no more ends than there are bins
  }

  /// References gained where the plane cuts `count` fragments into two halves.
  static std::size_t added_by(const SplitPlane& plane, std::size_t count) {
    return plane.left_count + plane.right_count - count;
  }

  [[noreturn]] static void refuse_size() {
    throw Error(ErrorCode::resource, "needs more than 2^30 nodes or 2^32 references", "kd_tree");
  }

  void check_progress() const {
    const double placed = static_cast<double>(placed_.load(std::memory_order_relaxed));
    context_.check(std::min(1.0, placed / static_cast<double>(total_)), "building");
  }

  std::size_t add_node(KdNode node, Output& out) {
    if (out.nodes.size() >= KdNode::kMaxIndex) refuse_size();
    meter_.take(kGrowth * sizeof(KdNode));
    out.nodes.push_back(node);
    return out.nodes.size() - 1;
  }

  /// Whether a split that costs more than a leaf may be made in the hope of better ones behind it.
  bool may_split_badly(Work& work, const SplitPlane& plane) const {
    const std::size_t count = work.fragments.size();
    const bool divides = std::min(plane.left_count, plane.right_count) < count;
    return divides && count >= kWorthABadSplit && ++work.bad_splits <= options_.bad_splits;
  }

  SplitPlane find_plane(Work& work, int depth) {
    const PlaneCost cost(work.cell, cost_, options_.empty_bonus);
    switch (options_.split) {
      case KdSplit::middle:
        return find_on_some_axis(find_plane_at_middle, work, cost, depth);
      case KdSplit::median:
        return find_on_some_axis(find_plane_at_median, work, cost, depth);
      default:
        return find_cheapest_plane(work, cost);
    }
  }

  /// The other axes are tried in turn where the first has no room or would divide nothing.
  template <class Find>
  SplitPlane find_on_some_axis(Find find, const Work& work, const PlaneCost& cost,
                               int depth) const {
    const int first = options_.axis == KdAxis::longest ? work.cell.longest_axis() : depth;
    SplitPlane plane;
    for (int i = 0; i < 3 && !plane.is_found(); ++i)
      plane = find(work.fragments, cost, static_cast<std::size_t>((first + i) % 3));
    return plane;
  }

  /// Sorts the ends of the fragments when the node is the first one on its path to be swept.
  SplitPlane find_cheapest_plane(Work& work, const PlaneCost& cost) {
    const std::size_t count = work.fragments.size();
    if (!work.has_events && count > sweep_limit_)
      return find_plane_by_bins(work.fragments, cost, options_.bins, context_.executor);
    if (!work.has_events) {
      work.lease = MemoryLease(meter_, count * (sizeof(Fragment) + kSweepBytesPerFragment));
      work.events = make_sweep_lists(work.fragments, context_.executor);
      work.has_events = true;
    }
    return find_plane_by_sweep(work.events, count, cost, context_.executor);
  }

  Work make_half(const Work& parent, const Aabb& cell, FragmentHalf half) {
    const std::size_t per_fragment =
        sizeof(Fragment) + (parent.has_events ? kSweepBytesPerFragment : 0);
    Work work;
    work.lease = MemoryLease(meter_, half.fragments.size() * per_fragment);
    work.cell = cell;
    work.has_events = parent.has_events;
    work.bad_splits = parent.bad_splits;
    if (parent.has_events) work.events = divide_sweep_lists(parent.events, half, context_.executor);
    work.fragments = std::move(half.fragments);
    return work;
  }

  const KdTreeOptions& options_;
  const BuildContext& context_;
  DivideRules rules_;
  SahCost cost_;
  int max_depth_;
  std::size_t sweep_limit_, total_;
  MemoryMeter meter_;
  std::atomic<std::uint64_t> placed_{0};
};

}  // namespace

int kd_depth_limit(const KdTreeOptions& options, std::size_t primitives) {
  if (options.max_depth > 0) return options.max_depth;
  return std::min(KdTree::kMaxDepth, 8 + 13 * static_cast<int>(std::bit_width(primitives)) / 10);
}

KdArrays build_kd_tree(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& root,
                       const KdTreeOptions& options, const BuildContext& context) {
  KdPolicy policy(source, options, context, refs.size());
  CellWork work = policy.make_root(refs, root);
  const std::size_t total = std::exchange(refs, {}).size();
  KdArrays tree;
  TopDown<KdPolicy>(policy, context, total).run(std::move(work), tree);
  tree.nodes.shrink_to_fit();
  tree.references.shrink_to_fit();
  return tree;
}

}  // namespace strahl
