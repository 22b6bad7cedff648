#include <algorithm>
#include <bit>
#include <limits>

#include <strahl/base/error.h>
#include <strahl/build/kd_policy.h>
#include <strahl/build/kd_retract.h>
#include <strahl/build/space_bins.h>
#include <strahl/build/space_empty.h>
#include <strahl/build/space_naive.h>
#include <strahl/build/space_walls.h>

namespace strahl {
namespace {

/// Smaller leaves cost too little to hope for good splits behind a bad one.
constexpr std::size_t kWorthABadSplit = 16;
/// Nodes at least this large ask whether to go on before they are divided.
constexpr std::size_t kCheckEvery = 1u << 14;
constexpr double kLossUnits = 0x1p32;
/// Slanted primitives leave empty space at all sizes: no more cuts in a row than this.
constexpr int kMostEmptyCuts = 3;
constexpr std::size_t kMaxReferences = std::numeric_limits<std::uint32_t>::max();
/// Growing arrays own up to twice what they hold.
constexpr std::size_t kGrowth = 2;

double volume(const Aabb& box) {
  const Vec3d e = box.extent();
  return e.x * e.y * e.z;
}

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

}  // namespace

void BinningLosses::add(double loss) {
  const auto units = static_cast<std::uint64_t>(std::clamp(loss, 0.0, 1.0) * kLossUnits);
  planes_.fetch_add(1, std::memory_order_relaxed);
  sum_.fetch_add(units, std::memory_order_relaxed);
  std::uint64_t largest = largest_.load(std::memory_order_relaxed);
  while (largest < units &&
         !largest_.compare_exchange_weak(largest, units, std::memory_order_relaxed)) {
  }
}

void BinningLosses::write(BuildReport& report) const {
  report.binned_planes = planes_.load(std::memory_order_relaxed);
  if (report.binned_planes == 0) return;
  const auto planes = static_cast<double>(report.binned_planes);
  report.binning_loss =
      static_cast<double>(sum_.load(std::memory_order_relaxed)) / kLossUnits / planes;
  report.largest_binning_loss =
      static_cast<double>(largest_.load(std::memory_order_relaxed)) / kLossUnits;
}

KdPolicy::KdPolicy(const PrimitiveSource& source, const KdRules& rules, const BuildContext& context,
                   std::size_t primitives)
    : rules_(rules),
      source_(source),
      context_(context),
      divide_rules_{rules.clip ? &source : nullptr, false},
      total_(primitives),
      meter_(context, rules.name) {}

CellWork KdPolicy::make_root(std::span<const PrimRef> refs, const Aabb& box) {
  CellWork work;
  work.lease = MemoryLease(meter_, refs.size() * (sizeof(PrimRef) + sizeof(Fragment)));
  work.cell = box;
  work.fragments = make_fragments(refs);
  root_volume_ = volume(box);
  work.spare = (rules_.max_growth - 1.0) * static_cast<double>(refs.size());
  return work;
}

bool KdPolicy::must_be_leaf(const CellWork& work, int depth) const {
  const std::size_t count = work.fragments.size();
  if (count >= kCheckEvery) check_progress();
  return count <= rules_.max_leaf || depth >= rules_.max_depth ||
         volume(work.cell) < rules_.min_volume * root_volume_;
}

bool KdPolicy::is_binned(const CellWork& work) const {
  return !work.has_events && work.fragments.size() > rules_.sweep_limit;
}

void KdPolicy::sort_ends(CellWork& work) {
  if (work.has_events) return;
  const std::size_t count = work.fragments.size();
  work.lease = MemoryLease(meter_, count * (sizeof(Fragment) + kSweepBytesPerFragment));
  work.events = make_sweep_lists(work.fragments, context_.executor);
  work.has_events = true;
}

SplitPlane KdPolicy::find_cheapest_plane(CellWork& work) {
  const PlaneCost cost = cost_in(work.cell);
  if (!is_binned(work)) return find_plane_exactly(work, cost);
  const BinnedPlane found =
      find_plane_by_bins(work.fragments, cost, rules_.bins, context_.executor);
  work.least_cost = found.least_cost;
  return found.plane;
}

SplitPlane KdPolicy::find_plane_exactly(CellWork& work, const PlaneCost& cost) {
  const std::size_t count = work.fragments.size();
  if (rules_.sweep == KdSweep::count)
    return find_plane_by_counting(work.fragments, cost, context_.executor);
  if (rules_.sweep == KdSweep::sort) {
    const MemoryLease lists(meter_, count * kSweepBytesPerFragment);
    return find_plane_by_sweep(make_sweep_lists(work.fragments, context_.executor), count, cost,
                               context_.executor);
  }
  sort_ends(work);
  return find_plane_by_sweep(work.events, count, cost, context_.executor);
}

SplitPlane KdPolicy::find_first_plane(const CellWork& work) const {
  const PlaneCost cost = cost_in(work.cell);
  SplitPlane plane;
  if (rules_.empty_cut > 0.0 && work.empty_cuts < kMostEmptyCuts)
    plane = find_empty_cut(work.fragments, cost, rules_.empty_cut);
  if (rules_.walls && !pays(work, plane)) plane = find_covered_plane(work.fragments, source_, cost);
  return pays(work, plane) ? plane : SplitPlane{};
}

bool KdPolicy::pays(const CellWork& work, const SplitPlane& plane) const {
  const std::size_t count = work.fragments.size();
  return plane.is_found() && plane.cost < sah_leaf_cost(rules_.cost, count) &&
         static_cast<double>(added_by(plane, count)) <= work.spare;
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
  if (!rules_.cost_stop) return divides;
  return divides && count >= kWorthABadSplit && ++work.bad_splits <= rules_.bad_splits;
}

std::pair<CellWork, CellWork> KdPolicy::divide_at(CellWork&& given, const SplitPlane& plane) {
  const CellWork work = std::move(given);  // freed when its halves are made
  if (work.least_cost < Aabb::kInf) losses_.add(1.0 - work.least_cost / plane.cost);
  return make_halves(work, plane);
}

std::pair<CellWork, CellWork> KdPolicy::make_halves(const CellWork& work, const SplitPlane& plane) {
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
  const bool cuts_empty = plane.left_count == 0 || plane.right_count == 0;
  both.first.empty_cuts = both.second.empty_cuts = cuts_empty ? work.empty_cuts + 1 : 0;
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
  const std::uint32_t word = count == 0 ? 0 : count == 1 ? references.front() : first;
  add_node(KdNode::leaf(word, count), count, out);
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
  out.counts.insert(out.counts.end(), right.counts.begin(), right.counts.end());
}

std::size_t KdPolicy::add_node(KdNode node, std::size_t fragments, Output& out) {
  if (out.nodes.size() >= KdNode::kMaxIndex) refuse_size();
  const std::size_t bytes = sizeof(KdNode) + (rules_.retract ? sizeof(std::uint32_t) : 0);
  meter_.take(kGrowth * bytes);
  out.nodes.push_back(node);
  if (rules_.retract) out.counts.push_back(static_cast<std::uint32_t>(fragments));
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

KdArrays KdPolicy::finish(Output&& out, const Aabb& root, BuildReport& report) {
  if (rules_.retract) {
    const std::size_t most = out.references.size() + out.nodes.size();
    if (most > kMaxReferences) refuse_size();
    const MemoryLease moved(meter_, out.references.size() * sizeof(std::uint32_t));
    retract_kd_tree(out, root, rules_.cost);
  }
  KdArrays tree = std::move(out);
  tree.nodes.shrink_to_fit();
  tree.references.shrink_to_fit();
  report = report_kd_tree(tree, root, rules_.cost);
  losses_.write(report);
  return tree;
}

int kd_depth_limit(int wanted, int limit, std::size_t primitives) {
  if (wanted > 0) return wanted;
  return std::min(limit, 8 + 13 * static_cast<int>(std::bit_width(primitives)) / 10);
}

}  // namespace strahl
