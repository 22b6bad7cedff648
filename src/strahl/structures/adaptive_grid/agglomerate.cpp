#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include <strahl/build/object_tree.h>
#include <strahl/structures/adaptive_grid/agglomerate.h>

namespace strahl {
namespace {

constexpr int kBins = 8;
/// Places to both sides among which a cluster looks for its partner.
constexpr std::size_t kReach = 12;
/// Chains in which but one pair is joined in a round end here.
constexpr int kMostRounds = 200;
constexpr std::size_t kGrain = 1024;
constexpr std::uint32_t kNone = ~0u;

/// Positions in `refs` such that neighbours are close.
std::vector<std::uint32_t> close_order(std::span<const PrimRef> refs, const Aabb& all,
                                       const BuildContext& context) {
  std::vector<PrimRef> boxes(refs.begin(), refs.end());
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].reference = static_cast<std::uint32_t>(i);
  const SahCost cost;
  const auto splitter = make_binned_splitter(boxes, kBins, cost);
  return build_object_tree(*splitter, boxes.size(), all, {cost, 1, 64}, context).references;
}

/// A cluster while it grows; members are a chain.
struct Growing {
  Aabb box;
  double area;
  std::uint32_t first, last;
};

class Agglomeration {
 public:
  Agglomeration(std::span<const PrimRef> refs, const MergeRules& rules, const BuildContext& context)
      : refs_(refs), rules_(rules), context_(context), next_(refs.size(), kNone) {
    Aabb all;
    for (const PrimRef& ref : refs) all.extend(ref.box);
    most_ = rules.part * all.half_area();
    for (const std::uint32_t i : close_order(refs, all, context))
      clusters_.push_back({refs[i].box, refs[i].box.half_area(), i, i});
  }

  std::vector<Cluster> run() {
    for (int round = 0; round < kMostRounds && join_pairs(); ++round) {
      const double left = static_cast<double>(clusters_.size());
      context_.check(1.0 - left / static_cast<double>(refs_.size()), "joining clusters");
    }
    std::vector<Cluster> made;
    for (const Growing& from : clusters_) made.push_back(finished(from));
    return made;
  }

 private:
  /// How well two clusters go together; the lower, the better. Never equal for two pairs of one
  /// cluster: of equally good ones, every second pair of neighbours is better, so that in a row of
  /// like clusters half of them choose each other.
  using Merit = std::array<double, 4>;

  std::optional<Merit> merit(std::size_t a, std::size_t b) const {
    const Growing &one = clusters_[a], &other = clusters_[b];
    const double area = Aabb::join(one.box, other.box).half_area(), sum = one.area + other.area;
    const double ratio = sum > 0.0 ? area / sum : area > 0.0 ? Aabb::kInf : 0.0;
    if (!(ratio < rules_.growth && area < most_)) return {};
    const std::size_t low = std::min(a, b), apart = std::max(a, b) - low;
    return Merit{ratio, static_cast<double>(apart), static_cast<double>(low & 1),
                 static_cast<double>(low)};
  }

  std::size_t best_partner(std::size_t at) const {
    const std::size_t begin = at < kReach ? 0 : at - kReach;
    const std::size_t end = std::min(clusters_.size(), at + kReach + 1);
    std::size_t best = at;
    std::optional<Merit> least;
    for (std::size_t i = begin; i < end; ++i) {
      if (i == at) continue;
      const std::optional<Merit> found = merit(at, i);
      if (found && (!least || *found < *least)) best = i, least = found;
    }
    return best;
  }

  /// False when there is none.
  bool join_pairs() {
    partner_.resize(clusters_.size());
    context_.executor.parallel_for(0, clusters_.size(), kGrain,
                                   [&](std::size_t begin, std::size_t end) {
                                     for (std::size_t i = begin; i < end; ++i)
                                       partner_[i] = best_partner(i);
                                   });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
      const std::size_t other = partner_[i];
      const bool is_pair = other != i && partner_[other] == i;
      if (is_pair && other < i) continue;
      if (is_pair) join(clusters_[i], clusters_[other]);
      clusters_[kept++] = clusters_[i];
    }
    const bool has_joined = kept < clusters_.size();
    clusters_.resize(kept);
    return has_joined;
  }

  void join(Growing& to, const Growing& from) {
    to.box.extend(from.box);
    to.area = to.box.half_area();
    next_[to.last] = from.first;
    to.last = from.last;
  }

  Cluster finished(const Growing& from) const {
    Cluster cluster{from.box, {}};
    for (std::uint32_t i = from.first; i != kNone; i = next_[i]) cluster.refs.push_back(refs_[i]);
    std::sort(cluster.refs.begin(), cluster.refs.end(),
              [](const PrimRef& a, const PrimRef& b) { return a.reference < b.reference; });
    return cluster;
  }

  std::span<const PrimRef> refs_;
  const MergeRules& rules_;
  const BuildContext& context_;
  double most_ = 0.0;
  std::vector<Growing> clusters_;
  std::vector<std::size_t> partner_;
  std::vector<std::uint32_t> next_;  ///< member after each
};

}  // namespace

std::vector<Cluster> agglomerate(std::span<const PrimRef> refs, const MergeRules& rules,
                                 const BuildContext& context) {
  if (refs.empty()) return {};
  return Agglomeration(refs, rules, context).run();
}

}  // namespace strahl
