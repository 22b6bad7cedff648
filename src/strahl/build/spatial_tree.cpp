#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include <strahl/build/object_split.h>
#include <strahl/build/spatial_tree.h>
#include <strahl/build/top_down.h>

namespace strahl {
namespace {

constexpr std::size_t kMaxBins = 64;
constexpr std::size_t kLeastCut = 8;  // references: smaller sets end in one block or two anyway
constexpr double kShortAxis = 0.2;    // of the longest: shorter ones are not cut

/// A run of the array and where its free room ends.
struct Room {
  ObjectSet set;
  std::size_t limit = 0;
  std::size_t spare() const { return limit - set.end; }
};

struct Cut {
  double cost = Aabb::kInf;
  int axis = 0;
  double plane = 0.0;
  std::size_t left = 0, right = 0;  ///< references on each side
  Aabb left_box, right_box;
};

/// The part of a box on one side of a plane.
Aabb below(Aabb box, int axis, double plane) {
  box.hi[axis] = std::min(box.hi[axis], plane);
  return box;
}
Aabb above(Aabb box, int axis, double plane) {
  box.lo[axis] = std::max(box.lo[axis], plane);
  return box;
}

class SpatialPolicy {
 public:
  using Work = Room;
  using Output = Tree;

  SpatialPolicy(const PrimitiveSource& source, std::vector<PrimRef>& refs, const Aabb& box,
                const SpatialRules& rules)
      : source_(source),
        refs_(refs),
        rules_(rules),
        bins_(std::min(static_cast<std::size_t>(rules.spatial_bins), kMaxBins)),
        root_area_(box.half_area()),
        splitter_(make_binned_splitter(refs, rules.object_bins, rules.cost)) {}

  std::optional<ObjectSplit> plan(const Room& room, int depth) const {
    if (room.set.size() == 1) return std::nullopt;
    const int levels_left = rules_.max_depth - depth;
    // What may still be cut must find its levels, too: count the free room as full.
    const std::size_t most = room.limit - room.set.begin;
    if (static_cast<int>(std::bit_width(most - 1)) >= levels_left)
      return splitter_->find_median(room.set);
    const ObjectSplit best = splitter_->find(room.set);
    return best.is_found() ? best : splitter_->find_median(room.set);
  }

  void leaf(const Room& room, Tree& out) const {
    const PrimRef& ref = refs_[room.set.begin];
    out.nodes.push_back({room.set.box, 0, static_cast<std::uint32_t>(out.references.size()), 1, 0});
    out.references.push_back(ref.reference);
  }

  std::size_t open(const Room& room, const ObjectSplit& split, Tree& out) const {
    out.nodes.push_back({room.set.box, 0, 0, 0, static_cast<std::uint32_t>(split.axis)});
    return out.nodes.size() - 1;
  }

  std::pair<Room, Room> divide(const Room& room, const ObjectSplit& split) const {
    const auto [left, right] = splitter_->divide(room.set, split);
    if (room.set.size() >= kLeastCut && room.spare() > 0 &&
        overlap(left.box, right.box) > rules_.least_overlap * root_area_) {
      const Cut cut = find_cut(room);
      if (cut.cost < split.cost) {
        if (const auto parts = carry_out(room, cut)) return *parts;
        const auto [again_left, again_right] = splitter_->divide(room.set, split);
        return share(room, again_left, again_right);
      }
    }
    return share(room, left, right);
  }

  void link(Tree& out, std::size_t inner) const {
    out.nodes[inner].right = static_cast<std::uint32_t>(out.nodes.size());
  }
  void append(Tree& out, const Tree& part) const { out.append(part); }
  std::size_t weight(const Room& room) const { return room.set.size(); }
  Tree make_output() const { return {}; }

 private:
  struct Bin {
    Aabb box;
    std::size_t begin = 0, end = 0;  ///< references that begin and end in it
  };

  static double overlap(const Aabb& a, const Aabb& b) {
    return Aabb::intersection(a, b).half_area();
  }

  /// Moves the right run behind the left one's share of the free room.
  std::pair<Room, Room> share(const Room& room, ObjectSet left, ObjectSet right) const {
    const std::size_t all = left.size() + right.size();
    const std::size_t left_spare = room.spare() * left.size() / all;
    const auto at = [&](std::size_t i) { return refs_.begin() + static_cast<std::ptrdiff_t>(i); };
    if (left_spare > 0) {
      std::move_backward(at(right.begin), at(right.end), at(right.end + left_spare));
      right.begin += left_spare, right.end += left_spare;
    }
    return {{left, left.end + left_spare}, {right, room.limit}};
  }

  double plane_of(const Aabb& box, int axis, std::size_t border) const {
    const double part = static_cast<double>(border) / static_cast<double>(bins_);
    return box.lo[axis] * (1.0 - part) + box.hi[axis] * part;
  }

  /// The bin of a coordinate, by the same planes that cut.
  std::size_t bin_of(const Aabb& box, int axis, double x) const {
    const double scale = static_cast<double>(bins_) / (box.hi[axis] - box.lo[axis]);
    const double guess = (x - box.lo[axis]) * scale;
    std::size_t bin = guess > 0.0 ? std::min(static_cast<std::size_t>(guess), bins_ - 1) : 0;
    while (bin > 0 && x < plane_of(box, axis, bin)) --bin;
    while (bin + 1 < bins_ && x >= plane_of(box, axis, bin + 1)) ++bin;
    return bin;
  }

  Cut find_cut(const Room& room) const {
    Cut best;
    const Vec3d extent = room.set.box.extent();
    for (int axis = 0; axis < 3; ++axis)
      if (extent[axis] > kShortAxis * norm_max(extent)) try_axis(room, axis, best);
    return best;
  }

  void try_axis(const Room& room, int axis, Cut& best) const {
    const Aabb& box = room.set.box;
    std::array<Bin, kMaxBins> bins;
    for (std::size_t i = room.set.begin; i < room.set.end; ++i) spread(refs_[i], box, axis, bins);
    std::array<Aabb, kMaxBins> right_box;
    std::array<std::size_t, kMaxBins> right_count;
    Aabb sum;
    std::size_t count = 0;
    for (std::size_t b = bins_; b-- > 1;) {
      sum.extend(bins[b].box), count += bins[b].end;
      right_box[b] = sum, right_count[b] = count;
    }
    Aabb left_box;
    std::size_t left = 0;
    for (std::size_t b = 1; b < bins_; ++b) {
      left_box.extend(bins[b - 1].box), left += bins[b - 1].begin;
      const std::size_t right = right_count[b];
      if (left == 0 || right == 0 || left == room.set.size() || right == room.set.size()) continue;
      if (left + right > room.set.size() + room.spare()) continue;
      const double whole = box.half_area();
      const double cost = sah_split_cost(rules_.cost, sah_share(left_box.half_area(), whole), left,
                                         sah_share(right_box[b].half_area(), whole), right);
      if (cost < best.cost)
        best = {cost, axis, plane_of(box, axis, b), left, right, left_box, right_box[b]};
    }
  }

  /// Adds a reference to the bins it reaches through: its box in slabs, as cutting the primitive
  /// itself for every bin would take most of the build.
  void spread(const PrimRef& ref, const Aabb& box, int axis,
              std::array<Bin, kMaxBins>& bins) const {
    const std::size_t first = bin_of(box, axis, ref.box.lo[axis]);
    std::size_t last = bin_of(box, axis, ref.box.hi[axis]);
    while (last > first && ref.box.hi[axis] <= plane_of(box, axis, last)) --last;
    ++bins[first].begin, ++bins[last].end;
    if (first == last) return bins[first].box.extend(ref.box);
    for (std::size_t b = first; b <= last; ++b) {
      Aabb slab = ref.box;
      if (b > first) slab = above(slab, axis, plane_of(box, axis, b));
      if (b < last) slab = below(slab, axis, plane_of(box, axis, b + 1));
      bins[b].box.extend(slab);
    }
  }

  /// Box of the part of a reference inside a box that lies within its own.
  Aabb part_of(const PrimRef& ref, const Aabb& box) const {
    return Aabb::intersection(source_.clip(ref.reference, box), box);
  }

  /// Empty when everything would end on one side.
  std::optional<std::pair<Room, Room>> carry_out(const Room& room, const Cut& cut) const {
    const auto begin = refs_.begin() + static_cast<std::ptrdiff_t>(room.set.begin);
    const auto end = refs_.begin() + static_cast<std::ptrdiff_t>(room.set.end);
    const auto across = std::partition(
        begin, end, [&](const PrimRef& r) { return r.box.hi[cut.axis] <= cut.plane; });
    const auto right = std::partition(
        across, end, [&](const PrimRef& r) { return r.box.lo[cut.axis] < cut.plane; });
    Sides sides = whole_sides(begin, across, right, end);
    const std::vector<PrimRef> cut_ones(across, right);
    std::vector<PrimRef> left_parts, right_parts;
    for (const PrimRef& ref : cut_ones) place(ref, cut, sides, left_parts, right_parts);
    if (sides.left == 0 || sides.right == 0) return std::nullopt;
    return lay_out(room, across, right, end, sides, left_parts, right_parts);
  }

  /// What lies on either side so far.
  struct Sides {
    Aabb left_box, right_box;
    std::size_t left, right;
  };
  template <class It>
  static Sides whole_sides(It begin, It across, It right, It end) {
    Sides sides{
        {}, {}, static_cast<std::size_t>(across - begin), static_cast<std::size_t>(end - right)};
    for (It i = begin; i != across; ++i) sides.left_box.extend(i->box);
    for (It i = right; i != end; ++i) sides.right_box.extend(i->box);
    return sides;
  }

  /// Cuts a reference, or keeps it whole on the side where that is cheaper, if the other side has
  /// something already.
  void place(const PrimRef& ref, const Cut& cut, Sides& sides, std::vector<PrimRef>& left_parts,
             std::vector<PrimRef>& right_parts) const {
    const Aabb low = part_of(ref, below(ref.box, cut.axis, cut.plane));
    const Aabb high = part_of(ref, above(ref.box, cut.axis, cut.plane));
    const double left_area = cut.left_box.half_area(), right_area = cut.right_box.half_area();
    const auto grown = [&](const Aabb& box) { return Aabb::join(box, ref.box).half_area(); };
    const auto left = static_cast<double>(cut.left), right = static_cast<double>(cut.right);
    const double both = left_area * left + right_area * right;
    const double all_left = grown(cut.left_box) * left + right_area * (right - 1.0);
    const double all_right = left_area * (left - 1.0) + grown(cut.right_box) * right;
    const bool stays_left = sides.right > 0 && all_left < both && all_left <= all_right;
    const bool stays_right = !stays_left && sides.left > 0 && all_right < both;
    if (!stays_right && !low.is_empty()) {
      left_parts.push_back({stays_left ? ref.box : low, ref.reference});
      sides.left_box.extend(left_parts.back().box), ++sides.left;
    }
    if (!stays_left && !high.is_empty()) {
      right_parts.push_back({stays_right ? ref.box : high, ref.reference});
      sides.right_box.extend(right_parts.back().box), ++sides.right;
    }
  }

  /// Left run, its parts, the right run and its parts, then the room is shared.
  template <class It>
  std::pair<Room, Room> lay_out(const Room& room, It across, It right, It end, const Sides& sides,
                                const std::vector<PrimRef>& left_parts,
                                const std::vector<PrimRef>& right_parts) const {
    const std::vector<PrimRef> right_whole(right, end);
    It at = std::copy(left_parts.begin(), left_parts.end(), across);
    const std::size_t middle = static_cast<std::size_t>(at - refs_.begin());
    at = std::copy(right_whole.begin(), right_whole.end(), at);
    at = std::copy(right_parts.begin(), right_parts.end(), at);
    const std::size_t last = static_cast<std::size_t>(at - refs_.begin());
    Room used = room;
    used.set.end = last;
    return share(used, {room.set.begin, middle, sides.left_box, {}},
                 {middle, last, sides.right_box, {}});
  }

  const PrimitiveSource& source_;
  std::vector<PrimRef>& refs_;
  const SpatialRules& rules_;
  std::size_t bins_;
  double root_area_;
  std::unique_ptr<ObjectSplitter> splitter_;
};

}  // namespace

Tree build_spatial_tree(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& box,
                        const SpatialRules& rules, const BuildContext& context) {
  const std::size_t count = refs.size();
  const auto room = count + static_cast<std::size_t>(rules.growth * static_cast<double>(count));
  context.require_memory(room * sizeof(PrimRef), "references of spatial splits");
  refs.resize(room);
  Tree tree;
  SpatialPolicy policy(source, refs, box, rules);
  TopDown<SpatialPolicy>(policy, context, count).run({{0, count, box, {}}, room}, tree);
  return tree;
}

}  // namespace strahl
