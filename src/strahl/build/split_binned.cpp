#include <algorithm>
#include <array>
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
  void add(const Aabb& one) { box.extend(one), ++count; }
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
    const auto used = static_cast<std::size_t>(bins_for(set));
    Bins x(used), y(used), z(used);
    Bins* const bins[3] = {&x, &y, &z};
    fill(set, best.centers, bins);
    for (int axis = 0; axis < 3; ++axis)
      if (best.centers.hi[axis] > best.centers.lo[axis])
        try_axis(set, axis, *bins[axis], used - 1, best);
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

  /// All axes in one pass; one without extent puts all in some bin and is not looked at.
  void fill(const ObjectSet& set, const Aabb& centers, Bins* const (&bins)[3]) const {
    const Scale x(centers, 0, bins_for(set)), y(centers, 1, bins_for(set)),
        z(centers, 2, bins_for(set));
    for (const PrimRef& ref : refs_of(set)) {
      (*bins[0])[x.bin(ref.box)].add(ref.box);
      (*bins[1])[y.bin(ref.box)].add(ref.box);
      (*bins[2])[z.bin(ref.box)].add(ref.box);
    }
  }

  void try_axis(const ObjectSet& set, int axis, Bins& bins, std::size_t last,
                ObjectSplit& best) const {
    const double whole = set.box.half_area();
    const auto cost_of = [&](const Bin& side) {
      return sah_share(side.box.half_area(), whole) * sah_leaf_cost(cost_, side.count);
    };
    std::array<double, kMaxBins> right;  // of what lies behind a bin; not set where it is empty
    Bin sum;
    for (std::size_t b = last; b > 0; --b) {
      if (bins[b].count > 0) sum.add(bins[b]);
      right[b - 1] = bins[b - 1].count > 0 ? cost_of(sum) : 0.0;
    }
    Bin left;
    for (std::size_t b = 0; b < last; ++b) {
      if (bins[b].count == 0) continue;  // the same division as the one before
      left.add(bins[b]);
      if (left.count == set.size()) return;
      const double cost = cost_.traverse + cost_of(left) + right[b];
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
