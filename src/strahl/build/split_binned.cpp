#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>

#include <strahl/build/split_in_place.h>

namespace strahl {
namespace {

constexpr int kMaxBins = 256;

struct Bin {
  Aabb box;
  std::size_t count = 0;
  void add(const Bin& o) { box.extend(o.box), count += o.count; }
};

/// Room for bins of which only the first `count` are made: small sets must not pay for all.
class Bins {
 public:
  explicit Bins(std::size_t count) : bins_(reinterpret_cast<Bin*>(room_)) {
    std::uninitialized_value_construct_n(bins_, count);
  }
  Bin& operator[](std::size_t i) { return bins_[i]; }

 private:
  static_assert(std::is_trivially_destructible_v<Bin>);
  alignas(Bin) std::byte room_[kMaxBins * sizeof(Bin)];
  Bin* bins_;
};

class BinnedSplitter final : public InPlaceSplitter {
 public:
  BinnedSplitter(std::span<PrimRef> refs, int bins, const SahCost& cost)
      : InPlaceSplitter(refs), bins_(std::clamp(bins, 2, kMaxBins)), cost_(cost) {}

  ObjectSplit find(const ObjectSet& set) const override {
    ObjectSplit best;
    best.centers = center_box(set);
    for (int axis = 0; axis < 3; ++axis)
      if (best.centers.hi[axis] > best.centers.lo[axis]) try_axis(set, axis, best);
    return best;
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    if (split.position == kMedian) return divide_at_median(set, split.axis);
    const Scale scale(split.centers, split.axis, bins_for(set));
    return divide_by(set, [&](const Aabb& box) { return scale.bin(box) <= split.position; });
  }

 private:
  /// Maps centres on one axis to bins; the same function finds and carries out a division.
  struct Scale {
    double lo, per_unit;
    int axis;
    std::size_t last;
    Scale(const Aabb& centers, int a, int bins)
        : lo(centers.lo[a]),
          per_unit(bins / (centers.hi[a] - centers.lo[a])),
          axis(a),
          last(static_cast<std::size_t>(bins - 1)) {
      // Where the reciprocal of the spread overflows, only the lowest bins are used; if it is but
      // one, no division is found on this axis.
      if (!(per_unit < Aabb::kInf)) per_unit = std::numeric_limits<double>::max();
    }
    std::size_t bin(const Aabb& box) const {
      const double x = (doubled_center(box)[axis] - lo) * per_unit;
      return x < static_cast<double>(last) ? static_cast<std::size_t>(x) : last;
    }
  };

  /// Few primitives need few bins: every one can have its own.
  int bins_for(const ObjectSet& set) const {
    return set.size() < static_cast<std::size_t>(bins_) / 2 ? static_cast<int>(2 * set.size())
                                                            : bins_;
  }

  void try_axis(const ObjectSet& set, int axis, ObjectSplit& best) const {
    const Scale scale(best.centers, axis, bins_for(set));
    Bins bins(scale.last + 1), right(scale.last + 1);
    for (const PrimRef& ref : refs_of(set)) {
      Bin& bin = bins[scale.bin(ref.box)];
      bin.box.extend(ref.box);
      ++bin.count;
    }
    Bin sum;
    for (std::size_t b = scale.last; b > 0; --b) sum.add(bins[b]), right[b] = sum;
    const double whole = set.box.half_area();
    Bin left;
    for (std::size_t b = 0; b < scale.last; ++b) {
      left.add(bins[b]);
      if (left.count == 0 || right[b + 1].count == 0) continue;
      const double cost =
          sah_split_cost(cost_, sah_share(left.box.half_area(), whole), left.count,
                         sah_share(right[b + 1].box.half_area(), whole), right[b + 1].count);
      if (cost < best.cost) best.cost = cost, best.axis = axis, best.position = b;
    }
  }

  int bins_;
  SahCost cost_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_binned_splitter(std::span<PrimRef> refs, int bins,
                                                     const SahCost& cost) {
  return std::make_unique<BinnedSplitter>(refs, bins, cost);
}

}  // namespace strahl
