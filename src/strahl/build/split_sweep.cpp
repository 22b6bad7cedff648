#include <algorithm>
#include <array>
#include <numeric>

#include <strahl/build/object_split.h>

namespace strahl {
namespace {

/// Keeps three orders of the primitives; a set is the same range of all three.
class SweepSplitter final : public ObjectSplitter {
 public:
  SweepSplitter(std::span<const PrimRef> refs, const SahCost& cost)
      : refs_(refs), cost_(cost), is_left_(refs.size()), area_(refs.size()), moved_(refs.size()) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<std::uint32_t>& order = order_[static_cast<std::size_t>(axis)];
      order.resize(refs.size());
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double ca = doubled_center(refs[a].box)[axis], cb = doubled_center(refs[b].box)[axis];
        return ca != cb ? ca < cb : a < b;
      });
    }
  }

  ObjectSplit find(const ObjectSet& set) const override {
    ObjectSplit best;
    for (int axis = 0; axis < 3; ++axis) try_axis(set, axis, best);
    return best;
  }

  ObjectSplit find_median(const ObjectSet& set) const override {
    Aabb centers;
    for (std::size_t i = set.begin; i < set.end; ++i)
      centers.extend(doubled_center(refs_[order_[0][i]].box));
    return {0.0, centers.longest_axis(), set.size() / 2, {}};
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) override {
    const std::size_t middle = set.begin + split.position;
    const auto& chosen = order_[static_cast<std::size_t>(split.axis)];
    for (std::size_t i = set.begin; i < set.end; ++i) is_left_[chosen[i]] = i < middle;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != split.axis) partition(set, axis);
    return {boxed(set.begin, middle), boxed(middle, set.end)};
  }

  void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const override {
    for (std::size_t i = set.begin; i < set.end; ++i)
      references.push_back(refs_[order_[0][i]].reference);
  }

 private:
  void try_axis(const ObjectSet& set, int axis, ObjectSplit& best) const {
    const auto& order = order_[static_cast<std::size_t>(axis)];
    Aabb box;
    for (std::size_t i = set.end; i-- > set.begin + 1;) {
      box.extend(refs_[order[i]].box);
      area_[i] = box.half_area();
    }
    const double whole = set.box.half_area();
    box = {};
    for (std::size_t i = set.begin; i + 1 < set.end; ++i) {
      box.extend(refs_[order[i]].box);
      const std::size_t left = i + 1 - set.begin;
      const double cost = sah_split_cost(cost_, sah_share(box.half_area(), whole), left,
                                         sah_share(area_[i + 1], whole), set.size() - left);
      if (cost < best.cost) best = {cost, axis, left, {}};
    }
  }

  /// Stable: each side keeps its order on this axis.
  void partition(const ObjectSet& set, int axis) {
    auto& order = order_[static_cast<std::size_t>(axis)];
    std::size_t left = set.begin, right = set.begin;
    for (std::size_t i = set.begin; i < set.end; ++i)
      if (is_left_[order[i]])
        order[left++] = order[i];
      else
        moved_[right++] = order[i];
    std::copy(moved_.begin() + static_cast<std::ptrdiff_t>(set.begin),
              moved_.begin() + static_cast<std::ptrdiff_t>(right),
              order.begin() + static_cast<std::ptrdiff_t>(left));
  }

  ObjectSet boxed(std::size_t begin, std::size_t end) const {
    ObjectSet set{begin, end, {}};
    for (std::size_t i = begin; i < end; ++i) set.box.extend(refs_[order_[0][i]].box);
    return set;
  }

  std::span<const PrimRef> refs_;
  SahCost cost_;
  std::array<std::vector<std::uint32_t>, 3> order_;
  std::vector<std::uint8_t> is_left_;  ///< per primitive; disjoint sets touch disjoint bytes
  mutable std::vector<double> area_;   ///< suffix areas; a set uses its own range only
  std::vector<std::uint32_t> moved_;
};

}  // namespace

std::unique_ptr<ObjectSplitter> make_sweep_splitter(std::span<const PrimRef> refs,
                                                    const SahCost& cost) {
  return std::make_unique<SweepSplitter>(refs, cost);
}

}  // namespace strahl
