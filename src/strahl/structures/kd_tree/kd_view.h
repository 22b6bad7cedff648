// structures/kd_tree/kd_view.h - a kd-tree as the loops of traverse/ see it.
//
// Thread safety: pure. The tree must outlive the view.
#pragma once

#include <strahl/structures/kd_tree/kd_links.h>

namespace strahl {

inline constexpr int kMaxKdDepth = 64;

/// @tparam kIsPadded nodes are farther apart than they are long. Shifting an index costs no more
///   when the distance is known only at run time: above 8 bytes addresses have no scale for it.
template <bool kIsPadded>
class KdView {
 public:
  static constexpr int kMaxChildren = 2;
  static constexpr int kMaxDepth = kMaxKdDepth;

  KdView(const KdNodes& nodes, const std::vector<std::uint32_t>& references, const KdLinks& links,
         const Aabb& box)
      : first_(nodes.data()),
        shift_(std::countr_zero(static_cast<unsigned>(nodes.distance()))),
        size_(static_cast<std::uint32_t>(nodes.size())),
        references_(references),
        links_(links),
        box_(box) {}

  std::uint32_t size() const { return size_; }
  NodeVisit enter(const PreparedRay& ray) const {
    return {0, clip_to_box(ray, box_.lo, box_.hi, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t node) const { return at(node).is_leaf(); }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return at(node).references(references_);
  }
  PlaneNodes plane(std::uint32_t node) const {
    const KdNode& inner = at(node);
    return {inner.axis(), inner.plane(), node + 1, inner.right()};
  }
  template <class C>
  [[gnu::always_inline]] int expand(const PreparedRay& ray, const NodeVisit& visit,
                                    NodeVisit* children, C&) const {
    return cross_plane(ray, plane(visit.node), visit.span, children);
  }
  const Gate& gate(std::uint32_t number) const { return links_.gates[number]; }
  const RopedCell& cell(std::uint32_t leaf) const { return links_.cells[links_.place[leaf]]; }

 private:
  const KdNode& at(std::size_t node) const {
    return *reinterpret_cast<const KdNode*>(first_ + (node << (kIsPadded ? shift_ : 3)));
  }

  const std::byte* first_;
  int shift_;
  std::uint32_t size_;
  const std::vector<std::uint32_t>& references_;
  const KdLinks& links_;
  const Aabb& box_;
};

}  // namespace strahl
