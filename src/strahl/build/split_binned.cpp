#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>

#include <strahl/build/object_split.h>

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

class BinnedSplitter final : public ObjectSplitter {
 public:
  BinnedSplitter(std::span<PrimRef> refs, int bins, const SahCost& cost)
      : refs_(refs), bins_(std::clamp(bins, 2, kMaxBins)), cost_(cost) {}

  ObjectSplit find(const ObjectSet& set) const override {
    ObjectSplit best;
    best.centers = center_box(set);
    for (int axis = 0; axis < 3; ++axis)
      if (best.centers.hi[axis] > best.centers.lo[axis]) try_axis(set, axis, best);
    return best;
  }

  ObjectSplit find_median(const ObjectSet& set) const override {
    const Aabb centers = center_box(set);
    return {0.0, centers.longest_axis(), kMedian, centers};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    const auto first = refs_.begin() + static_cast<std::ptrdiff_t>(set.begin);
    const auto last = refs_.begin() + static_cast<std::ptrdiff_t>(set.end);
    const int axis = split.axis;
    auto middle = first + (last - first) / 2;
    if (split.position == kMedian) {
      std::nth_element(first, middle, last, [axis](const PrimRef& a, const PrimRef& b) {
        const double ca = doubled_center(a.box)[axis], cb = doubled_center(b.box)[axis];
        return ca != cb ? ca < cb : a.reference < b.reference;
      });
    } else {
      const Scale scale(split.centers, axis, bins_for(set));
      middle = std::partition(first, last,
                              [&](const PrimRef& r) { return scale.bin(r.box) <= split.position; });
    }
    const auto size = static_cast<std::size_t>(middle - first);
    return {boxed(set.begin, set.begin + size), boxed(set.begin + size, set.end)};
  }

  void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const override {
    for (std::size_t i = set.begin; i < set.end; ++i) references.push_back(refs_[i].reference);
  }

 private:
  static constexpr std::size_t kMedian = ~std::size_t{0};

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

  Aabb center_box(const ObjectSet& set) const {
    Aabb box;
    for (std::size_t i = set.begin; i < set.end; ++i) box.extend(doubled_center(refs_[i].box));
    return box;
  }

  ObjectSet boxed(std::size_t begin, std::size_t end) const {
    ObjectSet set{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) set.box.extend(refs_[i].box);
    return set;
  }

  void try_axis(const ObjectSet& set, int axis, ObjectSplit& best) const {
    const Scale scale(best.centers, axis, bins_for(set));
    Bins bins(scale.last + 1), right(scale.last + 1);
    for (std::size_t i = set.begin; i < set.end; ++i) {
      Bin& bin = bins[scale.bin(refs_[i].box)];
      bin.box.extend(refs_[i].box);
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

  std::span<PrimRef> refs_;
  int bins_;
  SahCost cost_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_binned_splitter(std::span<PrimRef> refs, int bins,
                                                     const SahCost& cost) {
  return std::make_unique<BinnedSplitter>(refs, bins, cost);
}

}  // namespace strahl
