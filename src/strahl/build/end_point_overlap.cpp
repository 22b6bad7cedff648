#include <algorithm>
#include <array>
#include <atomic>
#include <utility>
#include <vector>

#include <strahl/build/end_point_overlap.h>
#include <strahl/geometry/outline.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Part of a triangle inside a box: at most 3 + 6 corners.
class Piece {
 public:
  explicit Piece(const Outline& triangle) : count_(3) {
    for (std::size_t i = 0; i < 3; ++i) corner_[i] = triangle.ball[i].center;
  }

  void cut_to(const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
      cut(axis, box.hi[axis], 1.0);
      cut(axis, box.lo[axis], -1.0);
    }
  }

  bool is_empty() const { return count_ < 3; }

  double area() const {
    Vec3d doubled{0, 0, 0};
    for (std::size_t i = 2; i < count_; ++i)
      doubled = doubled + cross(corner_[i - 1] - corner_[0], corner_[i] - corner_[0]);
    return 0.5 * length(doubled);
  }

 private:
  /// Keeps side * x[axis] <= side * plane.
  void cut(int axis, double plane, double side) {
    const auto depth = [&](const Vec3d& p) { return side * (plane - p[axis]); };
    const std::array<Vec3d, 10> from = corner_;
    const std::size_t n = count_;
    count_ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d &p = from[i], &q = from[(i + 1) % n];
      const double dp = depth(p), dq = depth(q);
      if (dp >= 0.0 && count_ < corner_.size()) corner_[count_++] = p;
      if ((dp < 0.0) == (dq < 0.0) || count_ == corner_.size()) continue;
      corner_[count_] = p + (dp / (dp - dq)) * (q - p);
      corner_[count_++][axis] = plane;
    }
  }

  std::array<Vec3d, 10> corner_;
  std::size_t count_;
};

class OverlapSum {
 public:
  OverlapSum(const Hierarchy& tree, const PrimitiveSource& source, const SahCost& cost)
      : tree_(tree), source_(source), cost_(cost), parent_(tree.nodes.size(), kNone) {
    first_leaf_.assign(source.size(), kNone);
    next_leaf_.assign(tree.references.size(), kNone);
    leaf_.assign(tree.references.size(), kNone);
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
      const HierarchyNode& node = tree.nodes[i];
      for (std::uint32_t c = 0; c < node.children; ++c) parent_[node.first + c] = i;
      for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
        std::uint32_t& first = first_leaf_[tree.references[at]];
        leaf_[at] = i, next_leaf_[at] = first, first = at;
      }
    }
  }

  struct Areas {
    double surface = 0.0, overlap = 0.0;  ///< of the triangles; weighted by what visits cost
  };

  Areas sum(std::uint32_t begin, std::uint32_t end) const {
    std::vector<std::uint32_t> owner(tree_.nodes.size(), kNone);  // last triangle found below
    Areas areas;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (first_leaf_[i] == kNone) continue;
      const Outline outline = source_.outline(i);
      if (!outline.is_triangle()) continue;
      for (std::uint32_t at = first_leaf_[i]; at != kNone; at = next_leaf_[at])
        for (std::uint32_t up = leaf_[at]; up != kNone && owner[up] != i; up = parent_[up])
          owner[up] = i;
      areas.surface += Piece(outline).area();
      areas.overlap += overlap_of(i, outline, owner);
    }
    return areas;
  }

 private:
  double overlap_of(std::uint32_t i, const Outline& outline,
                    const std::vector<std::uint32_t>& owner) const {
    double sum = 0.0;
    std::vector<std::pair<std::uint32_t, Piece>> waiting{{0, Piece(outline)}};
    while (!waiting.empty()) {
      const auto [at, whole] = waiting.back();
      waiting.pop_back();
      const HierarchyNode& node = tree_.nodes[at];
      Piece piece = whole;
      piece.cut_to(node.box);
      if (piece.is_empty()) continue;
      if (owner[at] != i)
        sum += piece.area() * (node.is_leaf() ? sah_leaf_cost(cost_, node.count) : cost_.traverse);
      for (std::uint32_t c = 0; c < node.children; ++c) waiting.push_back({node.first + c, piece});
    }
    return sum;
  }

  const Hierarchy& tree_;
  const PrimitiveSource& source_;
  SahCost cost_;
  std::vector<std::uint32_t> parent_;
  /// Places of a primitive among the references, as a list, and the leaf of each.
  std::vector<std::uint32_t> first_leaf_, next_leaf_, leaf_;
};

}  // namespace

double end_point_overlap(const Hierarchy& hierarchy, const PrimitiveSource& source,
                         const SahCost& cost, const BuildContext& context) {
  if (hierarchy.nodes.empty()) return 0.0;
  constexpr std::size_t kChunks = 64;
  const std::size_t grain = source.size() / kChunks + 1;
  const OverlapSum sums(hierarchy, source, cost);
  std::vector<OverlapSum::Areas> parts(kChunks);
  std::atomic<std::size_t> done{0};
  context.executor.parallel_for(0, source.size(), grain, [&](std::size_t from, std::size_t to) {
    parts[from / grain] =
        sums.sum(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to));
    context.check(static_cast<double>(++done) / kChunks, "end-point overlap");
  });
  OverlapSum::Areas all;
  for (const OverlapSum::Areas& part : parts)
    all.surface += part.surface, all.overlap += part.overlap;
  return all.surface > 0.0 ? all.overlap / all.surface : 0.0;
}

}  // namespace strahl
