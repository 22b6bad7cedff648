#include <algorithm>
#include <array>

#include <strahl/build/float_cut.h>
#include <strahl/math/aabb.h>
#include <strahl/math/float_round.h>

namespace strahl {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kShortAxis = 0.2f;  // of the longest: shorter ones are not cut
constexpr Int4 kThreeLanes = {-1, -1, -1, 0};

/// Equal slabs of a box on each axis. The same operations find and carry out a cut.
class Slabs {
 public:
  Slabs(const FloatBox& box, int bins)
      : least_(and4(box.lo, kThreeLanes)), last_(all4(static_cast<float>(bins - 1))) {
    const Float4 extent = box.extent();
    width_ = and4(extent / all4(static_cast<float>(bins)), kThreeLanes);
    const Float4 scale = all4(static_cast<float>(bins)) / extent;
    per_unit_ = and4(min4(scale, all4(std::numeric_limits<float>::max())), kThreeLanes);
  }
  /// Those in which a box begins.
  Int4 first(const FloatBox& box) const {
    const Float4 place = (and4(box.lo, kThreeLanes) - least_) * per_unit_;
    return __builtin_convertvector(min4(place, last_), Int4);
  }
  /// Those in which it ends; what ends on a border ends below it.
  Int4 last(const FloatBox& box, const Int4& first) const {
    const Float4 high = and4(-box.minus_hi, kThreeLanes);
    const Float4 place = min4((high - least_) * per_unit_, last_ + 1.0f);
    const Int4 below = __builtin_convertvector(place, Int4);
    const Int4 bin = below + (__builtin_convertvector(below, Float4) == place);
    return bin > first ? bin : first;
  }
  /// Lower border of a bin.
  float plane(int axis, int bin) const {
    return least_[axis] + static_cast<float>(bin) * width_[axis];
  }

 private:
  Float4 least_, last_, width_, per_unit_;
};

struct alignas(64) Bin {
  FloatBox box;
  std::int32_t begin, end;  ///< references that begin and end in it
};

/// What the slabs of three axes hold.
class SlabTable {
 public:
  SlabTable(const FloatBox& box, int bins) : slabs_(box, bins), count_(bins) {
    for (auto& axis : bins_)
      for (int b = 0; b < bins; ++b) axis[b] = {FloatBox::empty(), 0, 0};
  }

  void add(const FloatRef& ref) {
    const FloatBox box = ref.box();
    const Int4 first = slabs_.first(box), last = slabs_.last(box, first);
    for (int axis = 0; axis < 3; ++axis) {
      Bin* const bins = bins_[axis];
      ++bins[first[axis]].begin, ++bins[last[axis]].end;
      if (first[axis] == last[axis])
        bins[first[axis]].box.extend(box);
      else
        spread(box, axis, first[axis], last[axis]);
    }
  }

  struct Best {
    Float4 cost = all4(kInf);
    Int4 last_left{}, left{}, right{};
  };
  /// The cheapest plane on each axis.
  Best sweep(std::int32_t references, std::int32_t most) const {
    std::array<Float4, FloatCutter::kMaxBins> right_cost;
    std::array<Int4, FloatCutter::kMaxBins> right;
    Side side;
    for (int b = count_ - 1; b > 0; --b) {
      take(b, &Bin::end, side);
      const auto at = static_cast<std::size_t>(b - 1);
      right_cost[at] = side.cost(), right[at] = side.counts;
    }
    side = Side();
    Best best;
    for (int b = 0; b + 1 < count_; ++b) {
      take(b, &Bin::begin, side);
      const auto at = static_cast<std::size_t>(b);
      const Float4 cost = side.cost() + right_cost[at];
      const Int4 is_better = (cost < best.cost) & (side.counts < references) &
                             (right[at] < references) & (side.counts + right[at] <= most);
      best.cost = is_better ? cost : best.cost;
      best.last_left = is_better ? Int4{b, b, b, b} : best.last_left;
      best.left = is_better ? side.counts : best.left;
      best.right = is_better ? right[at] : best.right;
    }
    return best;
  }

  void describe(FloatCut& cut) const {
    cut.bins = count_, cut.plane = slabs_.plane(cut.axis, cut.first_right);
    cut.left_box = cut.right_box = FloatBox::empty();
    for (int b = 0; b < count_; ++b)
      (b < cut.first_right ? cut.left_box : cut.right_box).extend(bins_[cut.axis][b].box);
  }

 private:
  struct Side {
    FloatBox boxes[3] = {FloatBox::empty(), FloatBox::empty(), FloatBox::empty()};
    Int4 counts{};
    /// NaN where there is nothing, which is never less.
    Float4 cost() const { return half_areas(boxes) * __builtin_convertvector(counts, Float4); }
  };

  void take(int b, std::int32_t Bin::*count, Side& side) const {
    for (int axis = 0; axis < 3; ++axis) side.boxes[axis].extend(bins_[axis][b].box);
    side.counts += Int4{bins_[0][b].*count, bins_[1][b].*count, bins_[2][b].*count, 0};
  }

  void spread(const FloatBox& box, int axis, int first, int last) {
    FloatBox slab = box;
    for (int b = first; b <= last; ++b) {
      slab.minus_hi[axis] = b < last ? -slabs_.plane(axis, b + 1) : box.minus_hi[axis];
      bins_[axis][b].box.extend(slab);
      slab.lo[axis] = -slab.minus_hi[axis];
    }
  }

  Bin bins_[3][FloatCutter::kMaxBins];
  Slabs slabs_;
  int count_;
};

bool is_empty(const FloatBox& box) {
  const Float4 extent = box.extent();
  return extent[0] < 0.0f || extent[1] < 0.0f || extent[2] < 0.0f;
}

/// The part of a triangle up to a plane (sign 1) or from it on (-1).
Aabb part_box(const std::array<Vec3d, 3>& corners, int axis, double plane, double sign) {
  Aabb box;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % 3];
    const double from = sign * (plane - a[axis]), to = sign * (plane - b[axis]);
    if (from >= 0.0) box.extend(a);
    if ((from < 0.0) != (to < 0.0) && from != to) {
      Vec3d crossing = a + (from / (from - to)) * (b - a);
      crossing[axis] = plane;
      box.extend(crossing);
    }
  }
  return box;
}

/// What two boxes have in common, the first being rounded outward.
FloatBox common(const Aabb& part, double off, const FloatRef& ref) {
  FloatBox box = ref.box();
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::max(box.lo[axis], float_below(part.lo[axis] - off));
    box.minus_hi[axis] = std::max(box.minus_hi[axis], -float_above(part.hi[axis] + off));
  }
  return box;
}

FloatRef with_box(const FloatRef& ref, const FloatBox& box) {
  return {{box.lo[0], box.lo[1], box.lo[2]},
          ref.reference,
          {box.minus_hi[0], box.minus_hi[1], box.minus_hi[2]},
          ref.weight};
}

}  // namespace

std::pair<FloatBox, FloatBox> cut_box(const FloatThings& things, const FloatRef& ref, int axis,
                                      float plane) {
  FloatBox low = ref.box(), high = low;
  std::array<Vec3d, 3> corners;
  if (things.corners(ref.reference, corners)) {
    // A point of the triangle is within rounding() of one of these corners' triangle, which then is
    // on the plane's side or within rounding() of it. A crossing adds less than 2^-49 reach().
    const double off = things.rounding(), more = off + 0x1p-48 * things.reach();
    low = common(part_box(corners, axis, double{plane} + off, 1.0), more, ref);
    high = common(part_box(corners, axis, double{plane} - off, -1.0), more, ref);
  }
  low.minus_hi[axis] = std::max(low.minus_hi[axis], -plane);
  high.lo[axis] = std::max(high.lo[axis], plane);
  return {low, high};
}

FloatCut FloatCutter::find(const FloatSet& set, std::uint32_t spare) const {
  const auto bins = static_cast<int>(std::min(static_cast<std::size_t>(bins_), set.size() / 2 + 4));
  SlabTable table(set.box, bins);
  for (const FloatRef& ref : splitter_.refs_of(set)) table.add(ref);
  const auto count = static_cast<std::int32_t>(set.size());
  const SlabTable::Best best = table.sweep(count, count + static_cast<std::int32_t>(spare));
  const Float4 extent = set.box.extent();
  const float least = kShortAxis * std::max({extent[0], extent[1], extent[2]});
  FloatCut cut;
  for (int axis = 0; axis < 3; ++axis)
    if (extent[axis] > least && best.cost[axis] < cut.cost)
      cut.cost = best.cost[axis], cut.axis = axis;
  if (!cut.is_found()) return cut;
  cut.left = static_cast<std::uint32_t>(best.left[cut.axis]);
  cut.right = static_cast<std::uint32_t>(best.right[cut.axis]);
  cut.first_right = best.last_left[cut.axis] + 1;
  table.describe(cut);
  return cut;
}

/// The two sides as they are filled.
class FloatCutter::Sides {
 public:
  Sides(const FloatSet& set, const FloatCut& cut, std::uint32_t right_begin, FloatRef* to,
        const FloatThings& things)
      : cut_(cut), things_(things), to_(to) {
    const FloatBox none = FloatBox::empty();
    left = {set.begin, set.begin, !set.in_second, none, none};
    right = {right_begin, right_begin, !set.in_second, none, none};
    const auto l = static_cast<float>(cut.left), r = static_cast<float>(cut.right);
    left_area_ = half_area(cut.left_box), right_area_ = half_area(cut.right_box);
    left_count_ = l, right_count_ = r;
  }

  void add(FloatSet& side, const FloatRef& ref) {
    const FloatBox box = ref.box();
    const Float4 center = box.doubled_center();
    side.box.extend(box), side.centers.extend({center, -center});
    to_[side.end++] = ref;
  }

  /// Something that reaches across the plane: whole where that is cheaper, else cut.
  void place(const FloatRef& ref) {
    if (-ref.minus_hi[cut_.axis] <= cut_.plane) return add(left, ref);
    if (ref.lo[cut_.axis] >= cut_.plane) return add(right, ref);
    const float both = left_area_ * left_count_ + right_area_ * right_count_;
    const float all_left =
        grown(cut_.left_box, ref) * left_count_ + right_area_ * (right_count_ - 1.0f);
    const float all_right =
        left_area_ * (left_count_ - 1.0f) + grown(cut_.right_box, ref) * right_count_;
    if (all_left < both && all_left <= all_right) return add(left, ref);
    if (all_right < both) return add(right, ref);
    const auto [low, high] = cut_box(things_, ref, cut_.axis, cut_.plane);
    if (!is_empty(low)) add(left, with_box(ref, low));
    if (!is_empty(high)) add(right, with_box(ref, high));
  }

  FloatSet left, right;

 private:
  static float grown(FloatBox box, const FloatRef& ref) {
    box.extend(ref.box());
    return half_area(box);
  }

  const FloatCut& cut_;
  const FloatThings& things_;
  FloatRef* to_;
  float left_area_, right_area_, left_count_, right_count_;
};

std::pair<FloatSet, FloatSet> FloatCutter::divide(const FloatSet& set, const FloatCut& cut,
                                                  std::uint32_t right_begin) const {
  const Slabs slabs(set.box, cut.bins);
  Sides sides(set, cut, right_begin, splitter_.target(set), things_);
  for (const FloatRef& ref : splitter_.refs_of(set)) {
    const Int4 first = slabs.first(ref.box());
    if (first[cut.axis] >= cut.first_right)
      sides.add(sides.right, ref);
    else if (slabs.last(ref.box(), first)[cut.axis] < cut.first_right)
      sides.add(sides.left, ref);
    else
      sides.place(ref);
  }
  return {sides.left, sides.right};
}

}  // namespace strahl
