#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/build/memory_meter.h>
#include <strahl/build/octant_planes.h>
#include <strahl/build/top_down.h>

namespace strahl {
namespace {

/// Nodes at least this large ask whether to go on before they are divided.
constexpr std::size_t kCheckEvery = 1u << 14;

/// A cell, or a half or quarter of one on the way to its children: it is divided on one axis after
/// the other, so that the recursion is that of all builders.
struct OctantWork {
  Aabb cell;
  std::vector<PrimRef> refs;
  std::vector<std::uint32_t> own;  ///< of an inner node
  OctantPlanes planes;             ///< of the cell being divided
  int level = 0;
  int divided = 0;     ///< axes on which the cell is divided already
  double spare = 0.0;  ///< references that may still be added below
  MemoryLease lease;
};

enum class Half { below, above, both, neither };

class OctantPolicy {
 public:
  using Work = OctantWork;
  using Output = OctantParts;

  OctantPolicy(const PrimitiveSource& source, const OctantOptions& options, const OctantAxes& axes,
               const BuildContext& context, const char* what, std::size_t primitives)
      : source_(source),
        options_(options),
        axes_(axes),
        context_(context),
        meter_(context, what),
        total_(primitives),
        is_inner_(options.place == OctantPlace::inner),
        max_depth_(octant_depth_limit(options, primitives)) {}

  Work make_root(std::vector<PrimRef> refs, const Aabb& cell) {
    Work work;
    work.lease = MemoryLease(meter_, refs.size() * sizeof(PrimRef));
    work.cell = cell;
    work.spare = (options_.max_growth - 1.0) * static_cast<double>(refs.size());
    work.refs = std::move(refs);
    return work;
  }

  /// The axis to divide.
  std::optional<int> plan(Work& work, int) {
    if (work.divided > 0) return axes_[work.divided];
    const std::size_t count = work.refs.size();
    if (count >= kCheckEvery) check_progress();
    if (count <= static_cast<std::size_t>(options_.max_prims) || work.level >= max_depth_)
      return {};
    work.planes = find_octant_planes(work.refs, work.cell, options_, axes_);
    if (!work.planes.is_found) return {};
    if (is_inner_ ? !keep_own(work) : !may_grow(work)) return {};
    return axes_[0];
  }

  std::size_t open(const Work& work, int, Output& out) {
    if (work.divided == 0) {
      const OctantPlanes& p = work.planes;
      meter_.take(kGrowth * octant_stride(options_) * sizeof(Vec3d));
      out.planes.push_back(p.end);
      if (octant_stride(options_) > 1)
        out.planes.insert(out.planes.end(), {p.low, p.high, p.begin});
      add_node(true, work.own, out);
    }
    return 0;  // children are found by their order
  }

  std::pair<Work, Work> divide(Work&& given, int axis) {
    const Work work = std::move(given);  // freed when its halves are made
    std::pair<Work, Work> halves;
    prepare(work, axis, false, halves.first), prepare(work, axis, true, halves.second);
    for (const PrimRef& ref : work.refs) {
      const Half half = half_of(ref, work.planes, axis);
      const bool is_cut = half == Half::both;
      if (half == Half::below || is_cut) add(ref, is_cut, halves.first);
      if (half == Half::above || is_cut) add(ref, is_cut, halves.second);
    }
    finish(work.spare, halves);
    return halves;
  }

  void leaf(Work&& given, Output& out) {
    const Work work = std::move(given);
    std::vector<std::uint32_t> references(work.refs.size());
    std::transform(work.refs.begin(), work.refs.end(), references.begin(),
                   [](const PrimRef& ref) { return ref.reference; });
    add_node(false, references, out);
  }

  void link(Output&, std::size_t) {}

  void append(Output& out, Output&& right) {
    out.nodes.insert(out.nodes.end(), right.nodes.begin(), right.nodes.end());
    out.planes.insert(out.planes.end(), right.planes.begin(), right.planes.end());
    out.references.insert(out.references.end(), right.references.begin(), right.references.end());
  }

  std::size_t weight(const Work& work) const { return work.refs.size(); }
  Output make_output() const { return {}; }

 private:
  /// Growing arrays own up to twice what they hold.
  static constexpr std::size_t kGrowth = 2;

  void check_progress() const {
    const double placed = static_cast<double>(placed_.load(std::memory_order_relaxed));
    context_.check(std::min(1.0, placed / static_cast<double>(total_)), "building");
  }

  Half half_of(const PrimRef& ref, const OctantPlanes& planes, int axis) const {
    const double lo = ref.box.lo[axis], hi = ref.box.hi[axis];
    if (!is_inner_) {  // closed cells: what touches the plane lies in both halves
      if (hi < planes.begin[axis]) return Half::below;
      return lo > planes.end[axis] ? Half::above : Half::both;
    }
    const bool fits_below = planes.low[axis] <= lo && hi <= planes.end[axis];
    const bool fits_above = planes.begin[axis] <= lo && hi <= planes.high[axis];
    if (!fits_below && !fits_above) return Half::neither;
    if (fits_below && fits_above)
      return 0.5 * lo + 0.5 * hi <= planes.middle[axis] ? Half::below : Half::above;
    return fits_below ? Half::below : Half::above;
  }

  bool fits_a_child(const PrimRef& ref, const OctantPlanes& planes) const {
    for (int k = 0; k < axes_.count; ++k)
      if (half_of(ref, planes, axes_[k]) == Half::neither) return false;
    return true;
  }

  /// Sets apart what no child encloses; false when that is everything.
  bool keep_own(Work& work) {
    const auto descends = [this, &work](const PrimRef& ref) {
      return fits_a_child(ref, work.planes);
    };
    if (std::none_of(work.refs.begin(), work.refs.end(), descends)) return false;
    std::vector<PrimRef> rest;
    for (const PrimRef& ref : work.refs) {
      if (descends(ref))
        rest.push_back(ref);
      else
        work.own.push_back(ref.reference);
    }
    work.refs = std::move(rest);
    return true;
  }

  /// Whether the children may hold as many references as they would; takes what they add.
  bool may_grow(Work& work) const {
    double after = 0.0;
    for (const PrimRef& ref : work.refs) {
      double touched = 1.0;
      for (int k = 0; k < axes_.count; ++k)
        if (half_of(ref, work.planes, axes_[k]) == Half::both) touched *= 2.0;
      after += touched;
    }
    const double added = after - static_cast<double>(work.refs.size());
    if (added > work.spare) return false;
    work.spare -= added;
    return true;
  }

  void prepare(const Work& parent, int axis, bool is_above, Work& half) const {
    half.cell = parent.cell;
    const double plane = parent.planes.middle[axis];
    if (is_above)
      half.cell.lo[axis] = plane;
    else
      half.cell.hi[axis] = std::min(half.cell.hi[axis], plane);
    half.planes = parent.planes;
    const bool is_child = parent.divided + 1 == axes_.count;
    half.divided = is_child ? 0 : parent.divided + 1;
    half.level = parent.level + is_child;
  }

  /// With `exact`, a cut primitive is bounded anew by the part inside the half, or left out.
  void add(PrimRef ref, bool is_cut, Work& half) const {
    if (is_cut && options_.exact) {
      ref.box = Aabb::intersection(ref.box, source_.clip(ref.reference, half.cell));
      if (ref.box.is_empty()) return;
    }
    half.refs.push_back(ref);
  }

  /// What can be divided further shares the references that may still be added.
  void finish(double spare, std::pair<Work, Work>& halves) {
    const double below = divisible(halves.first), above = divisible(halves.second);
    const double share = below > 0.0 ? below / (below + above) : 0.0;
    halves.first.spare = spare * share;
    halves.second.spare = spare * (1.0 - share);
    for (Work* half : {&halves.first, &halves.second})
      half->lease = MemoryLease(meter_, half->refs.capacity() * sizeof(PrimRef));
  }
  double divisible(const Work& half) const {
    const std::size_t count = half.refs.size();
    return count > static_cast<std::size_t>(options_.max_prims) ? static_cast<double>(count) : 0.0;
  }

  void add_node(bool is_inner, const std::vector<std::uint32_t>& references, Output& out) {
    meter_.take(kGrowth * (sizeof(OctantParts::Node) + sizeof(OctantNode) +
                           references.size() * sizeof(std::uint32_t)));
    out.nodes.push_back({is_inner, static_cast<std::uint32_t>(references.size())});
    out.references.insert(out.references.end(), references.begin(), references.end());
    placed_.fetch_add(references.size(), std::memory_order_relaxed);
  }

  const PrimitiveSource& source_;
  const OctantOptions& options_;
  const OctantAxes& axes_;
  const BuildContext& context_;
  MemoryMeter meter_;
  std::size_t total_;
  bool is_inner_;
  int max_depth_;
  std::atomic<std::uint64_t> placed_{0};
};

}  // namespace

std::uint32_t octant_stride(const OctantOptions& options) {
  return options.place == OctantPlace::inner && options.looseness > 1.0 ? 4 : 1;
}

Aabb octant_root(const Aabb& box, const OctantOptions& options) {
  if (box.is_empty()) return box;
  const Vec3d size = box.extent();
  const double longest = norm_max(size);
  Aabb root = box;
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = options.cube ? longest : size[axis];
    const double rim = 0.5 * (wanted - size[axis]) + options.padding * wanted;
    root.lo[axis] -= rim, root.hi[axis] += rim;
  }
  return Aabb::join(root, box);
}

int octant_depth_limit(const OctantOptions& options, std::size_t primitives) {
  if (options.max_depth > 0) return options.max_depth;
  return std::min(kMaxOctantDepth, 5 + (static_cast<int>(std::bit_width(primitives)) + 1) / 2);
}

OctantParts build_octants(const PrimitiveSource& source, std::vector<PrimRef> refs,
                          const Aabb& root, const OctantOptions& options, const OctantAxes& axes,
                          const BuildContext& context, const char* what) {
  OctantPolicy policy(source, options, axes, context, what, refs.size());
  const std::size_t total = refs.size();
  OctantWork work = policy.make_root(std::move(refs), root);
  OctantParts parts;
  TopDown<OctantPolicy>(policy, context, total).run(std::move(work), parts);
  return parts;
}

}  // namespace strahl
