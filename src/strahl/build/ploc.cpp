#include <algorithm>
#include <cmath>
#include <utility>

#include <strahl/build/morton_order.h>
#include <strahl/build/ploc.h>

namespace strahl {
namespace {

constexpr std::size_t kGrain = 1024;

/// How good a pair of places is; the same from both sides, and no two pairs are equal.
struct PairKey {
  double area = Aabb::kInf;
  std::size_t gap = 0, is_odd = 0, first = 0;
  constexpr auto operator<=>(const PairKey&) const = default;
};

class Clustering {
 public:
  Clustering(std::span<const PrimRef> refs, int radius, const BuildContext& context)
      : radius_(static_cast<std::size_t>(radius)),
        context_(context),
        tree_(LinkedTree::of_leaves(refs)) {
    for (const MortonPlace& place : morton_order(refs, context)) active_.push_back(place.index);
  }

  LinkedTree run() {
    const double all = static_cast<double>(active_.size());
    while (active_.size() > 1) {
      context_.check(1.0 - static_cast<double>(active_.size()) / all, "building");
      find_neighbours();
      join_pairs();
    }
    tree_.root = active_.front();
    return std::move(tree_);
  }

 private:
  void find_neighbours() {
    neighbour_.resize(active_.size());
    context_.executor.parallel_for(0, active_.size(), kGrain,
                                   [&](std::size_t from, std::size_t to) {
                                     for (std::size_t i = from; i < to; ++i)
                                       neighbour_[i] = nearest(i);
                                   });
  }

  std::size_t nearest(std::size_t i) const {
    const std::size_t begin = i - std::min(i, radius_);
    const std::size_t end = std::min(active_.size(), i + radius_ + 1);
    const Aabb& box = tree_.nodes[active_[i]].box;
    PairKey best;
    std::size_t found = i;
    for (std::size_t j = begin; j < end; ++j) {
      if (j == i) continue;
      const double area = Aabb::join(box, tree_.nodes[active_[j]].box).half_area();
      if (area > best.area) continue;
      const std::size_t first = std::min(i, j);
      const PairKey key{area, j > i ? j - i : i - j, first & 1, first};
      if (key < best || found == i) best = key, found = j;
    }
    return found;
  }

  void join_pairs() {
    std::vector<std::uint8_t> is_gone(active_.size(), 0);
    const auto join = [&](std::size_t i, std::size_t j) {
      active_[std::min(i, j)] = tree_.join(active_[std::min(i, j)], active_[std::max(i, j)]);
      is_gone[std::max(i, j)] = 1;
    };
    std::vector<std::uint8_t> is_joined(active_.size(), 0);
    std::size_t joined = 0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      const std::size_t j = neighbour_[i];
      if (i > j || neighbour_[j] != i) continue;
      join(i, j), is_joined[i] = is_joined[j] = 1, ++joined;
    }
    if (joined < active_.size() / kFew) {
      for (std::size_t i = 0; i < active_.size(); ++i) {
        const std::size_t j = neighbour_[i];
        if (is_joined[i] || is_joined[j]) continue;
        join(i, j), is_joined[i] = is_joined[j] = 1;
      }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active_.size(); ++i)
      if (!is_gone[i]) active_[kept++] = active_[i];
    active_.resize(kept);
  }

  static constexpr std::size_t kFew = 16;  ///< a part of the clusters; usually a third are joined

  std::size_t radius_;
  const BuildContext& context_;
  LinkedTree tree_;
  std::vector<std::uint32_t> active_;  ///< clusters in the order of the curve
  std::vector<std::size_t> neighbour_;
};

}  // namespace

LinkedTree build_ploc_tree(std::span<const PrimRef> refs, int radius, const BuildContext& context) {
  return Clustering(refs, radius, context).run();
}

}  // namespace strahl
