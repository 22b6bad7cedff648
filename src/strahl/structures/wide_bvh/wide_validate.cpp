// structures/wide_bvh/wide_validate.cpp - the invariants of a wide tree, executable.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <strahl/structures/wide_bvh/wide_any_order.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>
#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_filter.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("wide_bvh: ") + broken);
}

/// A box in the frame, as stored.
struct StoredBox {
  static constexpr float kInf = std::numeric_limits<float>::infinity();
  float lo[3] = {kInf, kInf, kInf}, hi[3] = {-kInf, -kInf, -kInf};
};

/// The box without what the order of any hit has moved its low x plane outward, or more.
StoredBox without_order(StoredBox box) {
  box.lo[0] += std::abs(box.lo[0]) * 0x1p-19f + 0x1p-145f;
  return box;
}

bool encloses(const StoredBox& outer, const StoredBox& inner) {
  for (int a = 0; a < 3; ++a)
    if (!(outer.lo[a] <= inner.lo[a] && inner.hi[a] <= outer.hi[a])) return false;
  return true;
}

}  // namespace

class WideBvhChecker {
 public:
  WideBvhChecker(const WideBvh& bvh, const PrimitiveSource& source)
      : tree_(bvh.tree_), report_(bvh.report_), source_(source), covered_(source.size()) {}

  void run() {
    if (!tree_.is_empty()) {
      demand(tree_.width == 8 || tree_.width == 16, "width");
      demand(tree_.frame.reach > 0.0 && tree_.frame.reach <= 0x1p21, "the frame's reach");
      const float inf = StoredBox::kInf;
      check(tree_.root, {{-inf, -inf, -inf}, {inf, inf, inf}}, 0);
    }
    for (std::uint32_t i = 0; i < source_.size(); ++i) check_covered(i);
    demand(nodes_ == report_.nodes && leaves_ == report_.leaves, "report: nodes");
    demand(references_ == report_.references, "report: references");
    demand(deepest_ == report_.depth, "report: depth");
    demand(report_.bytes == tree_.arena.size(), "report: bytes");
  }

 private:
  void check(WideId id, const StoredBox& box, std::uint64_t depth) {
    ++nodes_;
    const auto begin = static_cast<std::size_t>(tree_.at(id) - tree_.arena.data());
    demand(begin + kWideSlack < tree_.arena.size(), "an id is out of range");
    const std::size_t bytes = is_leaf(id) ? bytes_of_block(id) : node_bytes(tree_.width);
    demand(begin + bytes + kWideSlack <= tree_.arena.size(), "an id is out of range");
    demand(depth <= static_cast<std::uint64_t>(kWideMaxDepth), "a node is too deep");
    if (is_leaf(id))
      check_block(id, box, depth);
    else
      check_node(tree_.at(id), box, depth);
  }

  std::size_t bytes_of_block(WideId id) const {
    const std::byte* block = tree_.at(id);
    return is_compact(block) ? compact_bytes(block, lanes_of(id)) : leaf_bytes(lanes_of(id));
  }

  void check_node(const std::byte* node, const StoredBox& box, std::uint64_t depth) {
    int used = 0;
    for (int slot = 0; slot < tree_.width; ++slot) {
      const StoredBox child = box_of(node, slot);
      if (child.lo[0] > child.hi[0]) {
        demand(is_empty_slot(child), "an empty slot can be entered");
        continue;
      }
      ++used;
      demand(encloses(box, without_order(child)), "a box does not enclose a child's");
      for (int a = 0; a < 3; ++a)
        demand(static_cast<double>(std::max(std::abs(child.lo[a]), std::abs(child.hi[a]))) <=
                   tree_.frame.reach,
               "a plane lies beyond the frame's reach");
      check(child_row(node, tree_.width)[slot], child, depth + 1);
    }
    demand(used >= 2, "a node has less than two children");
    if (tree_.width == kOrderedWidth) check_order(node);
  }

  static void check_order(const std::byte* node) {
    std::uint32_t slots = 0;
    for (std::size_t lane = 0; lane < kOrderedWidth; ++lane)
      slots |= 1u << ordered_slot(plane_row(node, kOrderedWidth, 0)[lane]);
    demand(slots == 0xffffu, "the order of any hit leaves out a slot");
  }

  StoredBox box_of(const std::byte* node, int slot) const {
    StoredBox box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = plane_row(node, tree_.width, a)[slot];
      box.hi[a] = plane_row(node, tree_.width, a + 3)[slot];
    }
    return box;
  }

  static bool is_empty_slot(const StoredBox& box) {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (int a = 0; a < 3; ++a)
      if (!(box.lo[a] > 0x1.ffffp127f) || box.hi[a] != -kInf) return false;  // x: order of any hit
    return true;
  }

  void check_block(WideId id, const StoredBox& box, std::uint64_t depth) {
    ++leaves_, deepest_ = std::max(deepest_, depth);
    const std::uint32_t lanes = lanes_of(id);
    const std::byte* block = tree_.at(id);
    references_ += lanes;
    demand(is_compact(block) == (tree_.layout == WideLayout::compact),
           "a block is not of the tree's layout");
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      const std::uint32_t reference = reference_row(block, lanes)[lane];
      demand(reference < source_.size(), "a reference is out of range");
      demand(lane == 0 || reference_row(block, lanes)[lane - 1] < reference,
             "references of a block do not ascend");
      for (int a = 0; a < 3; ++a) {
        covered_[reference].lo[a] = std::min(covered_[reference].lo[a], box.lo[a]);
        covered_[reference].hi[a] = std::max(covered_[reference].hi[a], box.hi[a]);
      }
    }
    if (is_rounded(block)) return check_rounded(block, lanes);
    if (is_compact(block)) check_indices(block, lanes);
    LeafBound bound;
    std::memcpy(&bound, block, sizeof bound);
    for (std::uint32_t lane = 0; lane < lanes; ++lane) check_lane(block, lanes, lane, bound);
  }

  /// The blocks that refer to a primitive must enclose it together.
  void check_covered(std::uint32_t reference) const {
    const StoredBox& box = covered_[reference];
    const Aabb bounds = source_.bounds(reference);
    demand((box.lo[0] <= box.hi[0]) == !bounds.is_empty(),
           "a primitive is in no block, or one that is never hit is in one");
    if (bounds.is_empty()) return;
    for (int a = 0; a < 3; ++a) {
      // (v - center) * scale in doubles is within 2^-53; planes were moved by more.
      const double lo = (bounds.lo[a] - tree_.frame.center[a]) * tree_.frame.scale;
      const double hi = (bounds.hi[a] - tree_.frame.center[a]) * tree_.frame.scale;
      demand(static_cast<double>(box.lo[a]) <= lo && hi <= static_cast<double>(box.hi[a]),
             "boxes do not enclose a primitive");
    }
  }

  void check_indices(const std::byte* block, std::uint32_t lanes) const {
    demand(distinct_of(block) <= kMostDistinct, "a block has too many corners");
    for (std::uint32_t i = 0; i < 3 * lanes; ++i)
      demand(index_row(block, lanes, 0)[i] < distinct_of(block),
             "a corner's index is out of range");
  }

  void check_rounded(const std::byte* block, std::uint32_t lanes) const {
    bool are_triangles = true;
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      TriangleVertices ignored;
      are_triangles = are_triangles && source_.triangle(reference_row(block, lanes)[lane], ignored);
    }
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
      if (are_triangles)
        check_rounded_lane(block, lanes, lane);
      else
        demand(std::isnan(compact_corners(block, lanes, lane).a.x),
               "a block of what is no triangle has corners");
    }
  }

  void check_rounded_lane(const std::byte* block, std::uint32_t lanes, std::uint32_t lane) const {
    const TriangleVertices stored = compact_corners(block, lanes, lane);
    TriangleVertices triangle;
    source_.triangle(reference_row(block, lanes)[lane], triangle);
    const double error = kCompactError * static_cast<double>(rounded_head(block).step());
    const Vec3d* const corners[] = {&stored.a, &stored.b, &stored.c};
    const Vec3d* const own[] = {&triangle.a, &triangle.b, &triangle.c};
    for (int i = 0; i < 3; ++i) {
      demand(Vec3d(Vec3f(*corners[i])) == *corners[i], "a block's corner is no float");
      demand(length(*corners[i] - tree_.frame.to_frame(*own[i])) <= error,
             "a block's corners are not the primitive's");
    }
    const double longest =
        std::max(length(stored.b - stored.a), length(stored.c - stored.a)) + 2 * error;
    demand(static_cast<double>(rounded_head(block).longest()) >= longest,
           "a block's error bound is too small");
  }

  void check_lane(const std::byte* block, std::uint32_t lanes, std::uint32_t lane,
                  const LeafBound& bound) const {
    TriangleVertices triangle;
    const std::uint32_t reference = reference_row(block, lanes)[lane];
    const bool is_triangle = source_.triangle(reference, triangle);
    const TriangleVertices stored = stored_corners(block, lanes, lane);
    if (!is_triangle) {
      demand(std::isnan(stored.a.x), "what is no triangle has corners");
      return;
    }
    const LaneCorners corners = lane_corners(triangle, tree_.frame);
    demand(stored.a == Vec3d(corners.a) && stored.b == Vec3d(corners.b) &&
               stored.c == Vec3d(corners.c),
           "a block's corners are not the primitive's");
    demand(!tree_.has_exact_corners ||
               (stored.a == triangle.a && stored.b == triangle.b && stored.c == triangle.c),
           "corners are not exact");
    const LeafBound own = leaf_bound({&corners, 1});
    demand(bound.per_distance <= own.per_distance && bound.constant <= own.constant,
           "a block's error bound is too small");
    demand(bound.to_t >= own.to_t, "a block's bound of t is too small");
  }

  const WideTree& tree_;
  const BuildReport& report_;
  const PrimitiveSource& source_;
  std::vector<StoredBox> covered_;  ///< union of the boxes of its blocks, per primitive
  std::uint64_t nodes_ = 0, leaves_ = 0, references_ = 0, deepest_ = 0;
};

void WideBvh::validate(const PrimitiveSource& source) const { WideBvhChecker(*this, source).run(); }

}  // namespace strahl
