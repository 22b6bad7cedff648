#include <algorithm>
#include <bit>
#include <limits>

#include <strahl/base/error.h>
#include <strahl/build/kd_policy.h>
#include <strahl/build/space_bins.h>

namespace strahl {
namespace {

/// Smaller leaves cost too little to hope for good splits behind a bad one.
constexpr std::size_t kWorthABadSplit = 16;
/// Nodes at least this large ask whether to go on before they are divided.
constexpr std::size_t kCheckEvery = 1u << 14;
constexpr std::size_t kMaxReferences = std::numeric_limits<std::uint32_t>::max();
/// Growing arrays own up to twice what they hold.
constexpr std::size_t kGrowth = 2;

/// References gained where the plane cuts `count` fragments into two halves.
std::size_t added_by(const SplitPlane& plane, std::size_t count) {
  return plane.left_count + plane.right_count - count;
}

/// What may still be added is shared by the number of fragments.
void share_spare(double spare, CellWork& left, std::size_t left_count, CellWork& right,
                 std::size_t right_count) {
  const double left_share =
      static_cast<double>(left_count) / static_cast<double>(left_count + right_count);
  left.spare = spare * left_share;
  right.spare = spare * (1.0 - left_share);
}

/// Counts leaves and sums up, over all nodes, the chance to be crossed times the work done there.
struct Survey {
  const KdArrays& tree;
  SahCost cost;
  double root_area;
  BuildReport report;

  void visit(std::uint32_t index, const Aabb& cell, std::uint64_t depth) {
    const KdNode& node = tree.nodes[index];
    const double share = sah_share(cell.half_area(), root_area);
    if (node.is_leaf()) {
      ++report.leaves;
      report.empty_leaves += node.count() == 0;
      report.references += node.count();
      report.depth = std::max(report.depth, depth);
      report.sah_cost += share * sah_leaf_cost(cost, node.count());
      return;
    }
    // A filter and the plane behind it are one step.
    if (!node.is_filter()) report.sah_cost += share * cost.traverse;
    Aabb left = cell, right = cell;
    if (!node.is_filter()) left.hi[node.axis()] = right.lo[node.axis()] = node.plane();
    visit(index + 1, left, depth + 1);
    visit(node.right(), right, depth + 1);
  }
};

}  // namespace

KdPolicy::KdPolicy(const PrimitiveSource& source, const KdRules& rules, const BuildContext& context,
                   std::size_t primitives)
    : rules_(rules),
      context_(context),
      divide_rules_{rules.clip ? &source : nullptr, false},
      total_(primitives),
      meter_(context, rules.name) {}

CellWork KdPolicy::make_root(std::span<const PrimRef> refs, const Aabb& box) {
  CellWork work;
  work.lease = MemoryLease(meter_, refs.size() * (sizeof(PrimRef) + sizeof(Fragment)));
  work.cell = box;
  work.fragments = make_fragments(refs);
  work.spare = (rules_.max_growth - 1.0) * static_cast<double>(refs.size());
  return work;
}

bool KdPolicy::must_be_leaf(const CellWork& work, int depth) const {
  const std::size_t count = work.fragments.size();
  if (count >= kCheckEvery) check_progress();
  return count <= rules_.max_leaf || depth >= rules_.max_depth;
}

SplitPlane KdPolicy::find_cheapest_plane(CellWork& work) {
  const PlaneCost cost(work.cell, rules_.cost, rules_.empty_bonus);
  const std::size_t count = work.fragments.size();
  if (!work.has_events && count > rules_.sweep_limit)
    return find_plane_by_bins(work.fragments, cost, rules_.bins, context_.executor);
  if (!work.has_events) {
    work.lease = MemoryLease(meter_, count * (sizeof(Fragment) + kSweepBytesPerFragment));
    work.events = make_sweep_lists(work.fragments, context_.executor);
    work.has_events = true;
  }
  return find_plane_by_sweep(work.events, count, cost, context_.executor);
}

bool KdPolicy::may_divide(CellWork& work, const SplitPlane& plane) const {
  const std::size_t count = work.fragments.size();
  if (!plane.is_found()) return false;
  if (plane.cost >= sah_leaf_cost(rules_.cost, count) && !may_split_badly(work, plane))
    return false;
  return static_cast<double>(added_by(plane, count)) <= work.spare;
}

/// Whether a split that costs more than a leaf may be made in the hope of better ones behind it.
bool KdPolicy::may_split_badly(CellWork& work, const SplitPlane& plane) const {
  const std::size_t count = work.fragments.size();
  const bool divides = std::min(plane.left_count, plane.right_count) < count;
  return divides && count >= kWorthABadSplit && ++work.bad_splits <= rules_.bad_splits;
}

std::pair<CellWork, CellWork> KdPolicy::divide_at(CellWork&& given, const SplitPlane& plane) {
  const CellWork work = std::move(given);  // freed when its halves are made
  DivideRules rules = divide_rules_;
  rules.wants_places = work.has_events;
  const std::size_t halves_count = plane.left_count + plane.right_count;
  const MemoryLease places(meter_, work.has_events ? 8 * work.fragments.size() : 0);
  const MemoryLease growing(meter_, halves_count * sizeof(Fragment));
  FragmentHalves halves = divide_fragments(work.fragments, work.cell, plane, rules);
  std::pair<CellWork, CellWork> both{
      make_half(work, below(work.cell, plane), std::move(halves.left)),
      make_half(work, above(work.cell, plane), std::move(halves.right))};
  const double spare = work.spare - static_cast<double>(added_by(plane, work.fragments.size()));
  share_spare(spare, both.first, plane.left_count, both.second, plane.right_count);
  return both;
}

std::pair<CellWork, CellWork> KdPolicy::divide_by(const CellWork& work,
                                                  const std::vector<bool>& is_left) {
  FragmentHalves halves;
  const MemoryLease places(meter_, 8 * work.fragments.size());
  for (FragmentHalf* half : {&halves.left, &halves.right})
    half->place.assign(work.fragments.size(), FragmentHalf::kNowhere);
  for (std::size_t i = 0; i < work.fragments.size(); ++i) {
    FragmentHalf& half = is_left[i] ? halves.left : halves.right;
    half.place[i] = static_cast<std::uint32_t>(half.fragments.size());
    half.fragments.push_back(work.fragments[i]);
    half.kept = half.fragments.size();
  }
  const std::size_t left = halves.left.kept, right = halves.right.kept;
  std::pair<CellWork, CellWork> both{make_half(work, work.cell, std::move(halves.left)),
                                     make_half(work, work.cell, std::move(halves.right))};
  share_spare(work.spare, both.first, left, both.second, right);
  return both;
}

void KdPolicy::leaf(CellWork&& given, Output& out) {
  const CellWork work = std::move(given);
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

void KdPolicy::append(Output& out, Output&& right) const {
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

std::size_t KdPolicy::add_node(KdNode node, Output& out) {
  if (out.nodes.size() >= KdNode::kMaxIndex) refuse_size();
  meter_.take(kGrowth * sizeof(KdNode));
  out.nodes.push_back(node);
  return out.nodes.size() - 1;
}

void KdPolicy::refuse_size() const {
  throw Error(ErrorCode::resource, "needs more than 2^30 nodes or 2^32 references",
              std::string(rules_.name));
}

void KdPolicy::check_progress() const {
  const double placed = static_cast<double>(placed_.load(std::memory_order_relaxed));
  context_.check(std::min(1.0, placed / static_cast<double>(total_)), "building");
}

CellWork KdPolicy::make_half(const CellWork& parent, const Aabb& cell, FragmentHalf half) {
  const std::size_t per_fragment =
      sizeof(Fragment) + (parent.has_events ? kSweepBytesPerFragment : 0);
  CellWork work;
  work.lease = MemoryLease(meter_, half.fragments.size() * per_fragment);
  work.cell = cell;
  work.has_events = parent.has_events;
  work.bad_splits = parent.bad_splits;
  if (parent.has_events) work.events = divide_sweep_lists(parent.events, half, context_.executor);
  work.fragments = std::move(half.fragments);
  return work;
}

int kd_depth_limit(int wanted, int limit, std::size_t primitives) {
  if (wanted > 0) return wanted;
  return std::min(limit, 8 + 13 * static_cast<int>(std::bit_width(primitives)) / 10);
}

BuildReport report_kd_tree(const KdArrays& tree, const Aabb& root, const SahCost& cost) {
  Survey survey{tree, cost, root.half_area(), {}};
  survey.visit(0, root, 0);
  survey.report.sah_cost /= cost.traverse;
  survey.report.nodes = tree.nodes.size();
  survey.report.bytes =
      tree.nodes.capacity() * sizeof(KdNode) + tree.references.capacity() * sizeof(std::uint32_t);
  return survey.report;
}

}  // namespace strahl
