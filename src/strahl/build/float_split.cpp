#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include <strahl/build/float_split.h>

namespace strahl {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr Int4 kThreeLanes = {-1, -1, -1, 0};

/// A cache line, so that one offset finds all of a bin.
struct alignas(64) Bin {
  FloatBox box;
  std::uint32_t weight, count;  ///< the latter only where they differ
};
constexpr int kBinShift = 6;
static_assert(sizeof(Bin) == 1 << kBinShift);

/// Maps doubled centres to bins; the same operations find and carry out a division.
struct BinScale {
  Float4 least, per_unit, last;
  BinScale(const FloatBox& centers, int bins) : least(and4(centers.lo, kThreeLanes)) {
    // Where the reciprocal overflows, all are in the lowest bins, and maybe in one.
    const Float4 scale = all4(static_cast<float>(bins)) / centers.extent();
    per_unit = and4(min4(scale, all4(std::numeric_limits<float>::max())), kThreeLanes);
    last = all4(static_cast<float>(bins - 1));
  }
  /// Offsets in bytes of a box's bins on the three axes.
  Int4 offsets(const FloatBox& box) const {
    const Float4 place = (and4(box.doubled_center(), kThreeLanes) - least) * per_unit;
    return __builtin_convertvector(min4(place, last), Int4) << kBinShift;
  }
};

/// Bins of three axes. Only those asked for are made: small sets must not pay for all.
class BinTable {
 public:
  explicit BinTable(int bins) : count_(bins) {
    for (auto& axis : bins_)
      for (int b = 0; b < bins; ++b) axis[b] = {FloatBox::empty(), 0, 0};
  }

  template <bool kWeighted>
  void fill(std::span<const FloatRef> refs, const BinScale& scale) {
    for (const FloatRef& ref : refs) add<kWeighted>(ref, scale);
  }

  template <bool kWeighted>
  void add(const FloatRef& ref, const BinScale& scale) {
    const FloatBox box = ref.box();
    const Int4 offsets = scale.offsets(box);
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = *reinterpret_cast<Bin*>(reinterpret_cast<std::byte*>(bins_[axis]) +
                                         static_cast<std::uint32_t>(offsets[axis]));
      bin.box.extend(box);
      if constexpr (kWeighted)
        bin.weight += ref.weight, ++bin.count;
      else
        ++bin.weight;
    }
  }

  /// The cheapest place to divide on each axis: bins up to `last_left` go to the left.
  struct Best {
    Float4 cost = all4(kInf);
    Int4 last_left{};
  };
  Best sweep() const {
    std::array<Float4, FloatSplitter::kMaxBins> right;  // cost of what lies behind a bin
    Side side;
    for (int b = count_ - 1; b > 0; --b) {
      take(b, side);
      right[static_cast<std::size_t>(b - 1)] = side.cost();
    }
    side = Side();
    Best best;
    for (int b = 0; b + 1 < count_; ++b) {
      take(b, side);
      // An empty side costs inf * 0, NaN, which is never less.
      const Float4 cost = side.cost() + right[static_cast<std::size_t>(b)];
      const Int4 is_less = cost < best.cost;
      best.cost = is_less ? cost : best.cost;
      best.last_left = is_less ? Int4{b, b, b, b} : best.last_left;
    }
    return best;
  }

  /// Fills in what lies on both sides.
  void describe(int last_left, FloatSplit& split) const {
    const Bin* bins = bins_[split.axis];
    split.left = split.right = FloatBox::empty();
    for (int b = 0; b <= last_left; ++b)
      split.left.extend(bins[b].box), split.left_weight += bins[b].weight,
          split.left_count += bins[b].count;
    for (int b = last_left + 1; b < count_; ++b) split.right.extend(bins[b].box);
  }

 private:
  /// What some bins of each axis hold.
  struct Side {
    FloatBox boxes[3] = {FloatBox::empty(), FloatBox::empty(), FloatBox::empty()};
    Int4 weights{};
    Float4 cost() const { return half_areas(boxes) * __builtin_convertvector(weights, Float4); }
  };

  void take(int b, Side& side) const {
    for (int axis = 0; axis < 3; ++axis) side.boxes[axis].extend(bins_[axis][b].box);
    side.weights += Int4{static_cast<std::int32_t>(bins_[0][b].weight),
                         static_cast<std::int32_t>(bins_[1][b].weight),
                         static_cast<std::int32_t>(bins_[2][b].weight), 0};
  }

  Bin bins_[3][FloatSplitter::kMaxBins];
  int count_;
};

}  // namespace

FloatSet FloatSplitter::bounded(std::uint32_t begin, std::uint32_t end) const {
  FloatSet set{begin, end, false, FloatBox::empty(), FloatBox::empty()};
  for (const FloatRef& ref : refs_of(set)) {
    const FloatBox box = ref.box();
    const Float4 center = box.doubled_center();
    set.box.extend(box), set.centers.extend({center, -center});
  }
  return set;
}

FloatSplit FloatSplitter::find(const FloatSet& set) const {
  // Few primitives need few bins.
  const auto bins = static_cast<int>(std::min(static_cast<std::size_t>(bins_), set.size() / 2 + 4));
  const BinScale scale(set.centers, bins);
  BinTable table(bins);
  if (are_weighted_)
    table.fill<true>(refs_of(set), scale);
  else
    table.fill<false>(refs_of(set), scale);
  const BinTable::Best best = table.sweep();
  FloatSplit split;
  for (int axis = 0; axis < 3; ++axis)
    if (best.cost[axis] < split.cost) split.cost = best.cost[axis], split.axis = axis;
  if (!split.is_found()) return split;
  split.scale = scale.per_unit[split.axis];
  split.first_right = static_cast<float>(best.last_left[split.axis] + 1);
  table.describe(best.last_left[split.axis], split);
  if (!are_weighted_) split.left_count = split.left_weight;
  return split;
}

std::pair<FloatSet, FloatSet> FloatSplitter::divide(const FloatSet& set, const FloatSplit& split,
                                                    std::uint32_t gap) const {
  const float least = set.centers.lo[split.axis];
  FloatRef* const to = target(set);
  const std::uint32_t middle = set.begin + split.left_count;
  std::uint32_t next_left = set.begin, next_right = middle + gap;
  FloatBox left = FloatBox::empty(), right = FloatBox::empty();
  for (const FloatRef& ref : refs_of(set)) {
    const bool is_left = (ref.doubled_center(split.axis) - least) * split.scale < split.first_right;
    to[is_left ? next_left : next_right] = ref;
    next_left += is_left, next_right += !is_left;
    // NaN leaves the other side's box as it is.
    const std::int32_t mask = -static_cast<std::int32_t>(is_left);
    const Int4 goes_left{mask, mask, mask, mask};
    const Float4 center = ref.box().doubled_center();
    left.extend({nan_where(center, ~goes_left), nan_where(-center, ~goes_left)});
    right.extend({nan_where(center, goes_left), nan_where(-center, goes_left)});
  }
  return {{set.begin, middle, !set.in_second, split.left, left},
          {middle + gap, set.end + gap, !set.in_second, split.right, right}};
}

std::pair<FloatSet, FloatSet> FloatSplitter::halve(const FloatSet& set, std::uint32_t gap) const {
  const Float4 extent = set.centers.extent();
  const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0
                   : extent[1] >= extent[2]                         ? 1
                                                                    : 2;
  using Key = std::tuple<float, std::uint32_t, std::size_t>;
  std::vector<Key> keys;
  keys.reserve(set.size());
  for (const FloatRef& ref : refs_of(set))
    keys.emplace_back(ref.doubled_center(axis), ref.reference, keys.size());
  const auto half = keys.begin() + static_cast<std::ptrdiff_t>(keys.size() / 2);
  std::nth_element(keys.begin(), half, keys.end());
  const auto middle = set.begin + static_cast<std::uint32_t>(set.size() / 2);
  const FloatBox none = FloatBox::empty();
  FloatSet sides[2] = {{set.begin, middle, !set.in_second, none, none},
                       {middle + gap, set.end + gap, !set.in_second, none, none}};
  std::uint32_t next[2] = {sides[0].begin, sides[1].begin};
  std::size_t place = 0;
  for (const FloatRef& ref : refs_of(set)) {
    const bool is_right = !(Key{ref.doubled_center(axis), ref.reference, place++} < *half);
    const Float4 center = ref.box().doubled_center();
    sides[is_right].box.extend(ref.box()), sides[is_right].centers.extend({center, -center});
    target(set)[next[is_right]++] = ref;
  }
  return {sides[0], sides[1]};
}

}  // namespace strahl
