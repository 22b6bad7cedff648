#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <utility>

#include <strahl/build/agglomerative.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// A cluster and the area of the box it has in common with the one asked for.
struct Nearest {
  double area = Aabb::kInf;
  std::uint32_t cluster = kNone;
};

/// A full binary tree over buckets of clusters. Node k has children 2k + 1 and 2k + 2.
class ClusterIndex {
 public:
  ClusterIndex(const LinkedTree& tree, std::vector<std::uint32_t> clusters)
      : tree_(tree), slots_(std::move(clusters)) {
    const std::size_t buckets = std::bit_ceil((slots_.size() + kBucket - 1) / kBucket);
    nodes_.resize(2 * buckets - 1);
    build(0, 0, slots_.size());
  }

  std::size_t size() const { return slots_.size(); }
  /// Clusters left, in the order of the index.
  std::vector<std::uint32_t> rest() const {
    std::vector<std::uint32_t> clusters;
    for (const std::uint32_t cluster : slots_)
      if (cluster != kNone) clusters.push_back(cluster);
    return clusters;
  }
  /// Calls visit(slot, cluster) for all.
  template <class Visit>
  void for_slots(Visit visit) const {
    for (std::uint32_t i = 0; i < slots_.size(); ++i)
      if (slots_[i] != kNone) visit(i, slots_[i]);
  }

  /// The joined cluster has the slot of one part, the other slot is empty from now on.
  void replace(std::uint32_t slot, std::uint32_t other, std::uint32_t joined) {
    slots_[slot] = joined, slots_[other] = kNone;
    refresh(slot), refresh(other);
  }

  /// The nearest other cluster, first of its own bucket.
  Nearest find(std::uint32_t slot) const {
    const Query query{tree_.nodes[slots_[slot]].box, slots_[slot]};
    const std::size_t own = bucket_of(slot);
    Nearest best;
    scan(nodes_[own], query, best);
    std::array<std::pair<double, std::size_t>, 64> waiting{{{bound(nodes_[0], query.box), 0}}};
    for (std::size_t n = 1; n > 0;) {
      const auto [least, at] = waiting[--n];
      if (least >= best.area) continue;
      if (is_bucket(at)) {
        if (at != own) scan(nodes_[at], query, best);
        continue;
      }
      std::pair near{bound(nodes_[2 * at + 1], query.box), 2 * at + 1};
      std::pair far{bound(nodes_[2 * at + 2], query.box), 2 * at + 2};
      if (far.first < near.first) std::swap(near, far);
      waiting[n++] = far, waiting[n++] = near;
    }
    return best;
  }

 private:
  static constexpr std::size_t kBucket = 4;

  struct Node {
    Aabb points;  ///< holds a point of every cluster below
    Vec3d least;  ///< extents that every box below has
    std::uint32_t begin = 0, end = 0, count = 0;
  };
  struct Query {
    Aabb box;
    std::uint32_t cluster;
  };

  bool is_bucket(std::size_t node) const { return 2 * node + 1 >= nodes_.size(); }

  void build(std::size_t node, std::size_t begin, std::size_t end) {
    Node& n = nodes_[node];
    n.begin = static_cast<std::uint32_t>(begin), n.end = static_cast<std::uint32_t>(end);
    for (std::size_t i = begin; i < end; ++i) n.points.extend(tree_.nodes[slots_[i]].box.center());
    if (is_bucket(node)) return sum_up(node);
    const int axis = n.points.longest_axis();
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return slots_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
      const double ca = tree_.nodes[a].box.center()[axis], cb = tree_.nodes[b].box.center()[axis];
      return ca != cb ? ca < cb : a < b;
    });
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
    sum_up(node);
  }

  void sum_up(std::size_t node) {
    Node& n = nodes_[node];
    n.least = Vec3d::all(Aabb::kInf), n.count = 0;
    if (!is_bucket(node)) {
      for (const std::size_t child : {2 * node + 1, 2 * node + 2})
        n.least = min(n.least, nodes_[child].least), n.count += nodes_[child].count;
      return;
    }
    for (std::uint32_t i = n.begin; i < n.end; ++i) {
      if (slots_[i] == kNone) continue;
      n.least = min(n.least, tree_.nodes[slots_[i]].box.extent()), ++n.count;
    }
  }

  std::size_t bucket_of(std::uint32_t slot) const {
    std::size_t node = 0;
    while (!is_bucket(node)) node = 2 * node + (slot < nodes_[2 * node + 1].end ? 1 : 2);
    return node;
  }

  void refresh(std::uint32_t slot) {
    std::size_t node = bucket_of(slot);
    for (sum_up(node); node > 0;) sum_up(node = (node - 1) / 2);
  }

  /// No cluster below has less area in common with the box.
  static double bound(const Node& node, const Aabb& box) {
    if (node.count == 0) return Aabb::kInf;
    Vec3d extent = node.least;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = std::min(box.lo[axis], node.points.hi[axis]);
      const double high = std::max(box.hi[axis], node.points.lo[axis]);
      extent[axis] = std::max(extent[axis], high - low);
    }
    return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
  }

  void scan(const Node& bucket, const Query& query, Nearest& best) const {
    for (std::uint32_t i = bucket.begin; i < bucket.end; ++i) {
      if (slots_[i] == kNone || slots_[i] == query.cluster) continue;
      const double area = Aabb::join(query.box, tree_.nodes[slots_[i]].box).half_area();
      if (area < best.area) best = {area, slots_[i]};
    }
  }

  const LinkedTree& tree_;
  std::vector<std::uint32_t> slots_;
  std::vector<Node> nodes_;
};

class Agglomeration {
 public:
  Agglomeration(std::span<const PrimRef> refs, const BuildContext& context)
      : context_(context), tree_(LinkedTree::of_leaves(refs)) {
    nearest_.resize(2 * refs.size());
    slot_.resize(2 * refs.size(), kNone);
    followers_.resize(2 * refs.size(), kNone);
    next_follower_.resize(2 * refs.size(), kNone);
    for (std::uint32_t i = 0; i < refs.size(); ++i) searching_.push_back(i);
  }

  LinkedTree run() {
    left_ = searching_.size();
    const double all = static_cast<double>(left_);
    std::vector<std::uint32_t> clusters = searching_;
    while (left_ > 1) {
      ClusterIndex index(tree_, std::move(clusters));
      index.for_slots([&](std::uint32_t slot, std::uint32_t cluster) { slot_[cluster] = slot; });
      while (left_ > 1 && left_ > index.size() / 2) {
        context_.check(1.0 - static_cast<double>(left_) / all, "building");
        const std::size_t before = left_;
        search(index);
        join_mutual(index);
        // Of all pairs the nearest are each other's nearest.
        if (left_ == before)
          throw std::logic_error("agglomerative: no clusters are each other's nearest");
      }
      clusters = index.rest();
    }
    return std::move(tree_);
  }

 private:
  void search(const ClusterIndex& index) {
    constexpr std::size_t kGrain = 128;
    context_.executor.parallel_for(0, searching_.size(), kGrain,
                                   [&](std::size_t from, std::size_t to) {
                                     for (std::size_t i = from; i < to; ++i)
                                       nearest_[searching_[i]] = index.find(slot_[searching_[i]]);
                                   });
  }

  /// Only what has just searched can have become mutual. What followed a joined cluster searches
  /// next, and so do the new clusters.
  void join_mutual(ClusterIndex& index) {
    for (const std::uint32_t i : searching_) {
      const std::uint32_t target = nearest_[i].cluster;
      if (target == kNone) throw std::logic_error("agglomerative: a cluster has no nearest");
      next_follower_[i] = followers_[target], followers_[target] = i;
    }
    std::vector<std::uint32_t> next;
    for (const std::uint32_t i : searching_) {
      const std::uint32_t j = nearest_[i].cluster;
      if (slot_[i] == kNone || slot_[j] == kNone || nearest_[j].area != nearest_[i].area) continue;
      const std::uint32_t joined = tree_.join(i, j);
      slot_[joined] = slot_[i];
      index.replace(slot_[i], slot_[j], joined);
      slot_[i] = slot_[j] = kNone;
      --left_;
      next.push_back(joined);
      for (const std::uint32_t part : {i, j})
        for (std::uint32_t f = followers_[part]; f != kNone; f = next_follower_[f])
          next.push_back(f);
    }
    std::erase_if(next, [&](std::uint32_t cluster) { return slot_[cluster] == kNone; });
    searching_ = std::move(next);
  }

  const BuildContext& context_;
  LinkedTree tree_;
  std::size_t left_ = 0;  ///< clusters
  std::vector<Nearest> nearest_;
  std::vector<std::uint32_t> slot_;                       ///< in the index; kNone once joined
  std::vector<std::uint32_t> followers_, next_follower_;  ///< lists of those it is nearest to
  std::vector<std::uint32_t> searching_;
};

}  // namespace

LinkedTree build_agglomerative_tree(std::span<const PrimRef> refs, const BuildContext& context) {
  return Agglomeration(refs, context).run();
}

}  // namespace strahl
