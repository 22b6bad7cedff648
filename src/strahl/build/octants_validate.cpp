// build/octants_validate.cpp - the invariants of octrees and quadtrees, executable.
#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>

#include <strahl/build/octants.h>

namespace strahl {

/// Walks the tree with the primitives that may lie in each cell.
class OctantChecker {
 public:
  OctantChecker(const OctantTree& tree, const PrimitiveSource& source)
      : tree_(tree), source_(source), is_inner_(tree.options_.place == OctantPlace::inner) {}

  void run() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      if (!source_.bounds(i).is_empty()) all.push_back(i);
    times_.assign(source_.size(), 0);
    visit(0, {tree_.root_, tree_.box_, 0}, all);
    demand(nodes_ == tree_.nodes_.size(), "nodes beyond the last leaf");
    demand(next_reference_ == tree_.references_.size(), "references beyond the last node");
    demand(next_block_ * tree_.stride_ == tree_.planes_.size(), "planes beyond the last block");
    for (const std::uint32_t i : all) {
      demand(times_[i] > 0, "a primitive is in no node");
      demand(!is_inner_ || times_[i] == 1, "a primitive is in several nodes");
    }
    check_report(tree_.report_);
  }

 private:
  struct Place {
    Aabb cell, reach;
    int depth;
  };

  void demand(bool holds, const char* broken) const {
    if (!holds) throw std::logic_error(std::string(tree_.what_) + ": " + broken);
  }

  void visit(std::uint32_t index, const Place& at, const std::vector<std::uint32_t>& candidates) {
    ++nodes_;
    demand(index < tree_.nodes_.size(), "a child beyond the last node");
    const OctantNode& node = tree_.nodes_[index];
    demand(node.first == next_reference_, "nodes do not share out the references in order");
    next_reference_ += node.count;
    demand(next_reference_ <= tree_.references_.size(), "a node's references are out of range");
    check_references(tree_.references(index), at);
    deepest_ = std::max(deepest_, at.depth);
    demand(at.depth <= tree_.max_depth_, "a node is too deep");
    if (!tree_.is_leaf(index)) return visit_inner(index, at, candidates);
    ++leaves_, empty_ += node.count == 0;
    if (!is_inner_) check_leaf(tree_.references(index), at.cell, candidates);
  }

  void visit_inner(std::uint32_t index, const Place& at,
                   const std::vector<std::uint32_t>& candidates) {
    const std::uint32_t block = tree_.nodes_[index].block;
    demand(block == next_block_++, "blocks are not numbered depth first");
    demand((std::size_t{block} + 1) * tree_.stride_ <= tree_.planes_.size(),
           "a block without planes");
    check_planes(block, at.cell);
    if (tree_.options_.traversal == OctantTraversal::neighbour) {
      demand(tree_.parents_.at(block) == index, "a block does not know its parent");
      demand(tree_.reaches_.at(block) == at.reach, "a block does not know its reach");
    }
    if (is_inner_)
      check_own(tree_.references(index), block, at.reach);
    else
      demand(tree_.nodes_[index].count == 0, "an inner node has references");
    for (std::uint32_t c = 0; c < tree_.axes_.children(); ++c) {
      const Place part = child_of(at, block, c);
      visit(tree_.child(block) + c, part, is_inner_ ? candidates : inside(part.cell, candidates));
    }
  }

  Place child_of(const Place& at, std::uint32_t block, std::uint32_t child) const {
    return {tree_.part(at.cell, block, child), tree_.part(at.reach, block, child), at.depth + 1};
  }

  void check_planes(std::uint32_t block, const Aabb& cell) const {
    const Vec3d &end = tree_.end(block), &begin = tree_.begin(block);
    const bool is_strict = tree_.stride_ == 1;
    bool is_divided = false;
    for (int k = 0; k < tree_.axes_.count; ++k) {
      const int axis = tree_.axes_[k];
      demand(begin[axis] <= end[axis], "halves leave a gap");
      const bool is_cut = end[axis] < Aabb::kInf;
      is_divided |= is_cut;
      if (!is_strict || !is_cut) continue;
      demand(cell.lo[axis] < end[axis] && end[axis] < cell.hi[axis],
             "a plane is not strictly inside its cell");
      if (tree_.options_.split == OctantSplit::middle)
        demand(end[axis] == cell.center()[axis], "a plane is not in the middle");
    }
    demand(is_divided, "an inner node is not divided");
  }

  void check_references(std::span<const std::uint32_t> references, const Place& at) {
    demand(std::adjacent_find(references.begin(), references.end(), std::greater_equal<>()) ==
               references.end(),
           "references of a node do not ascend");
    for (const std::uint32_t i : references) {
      demand(i < source_.size(), "a reference is out of range");
      const Aabb box = source_.bounds(i);
      demand(!box.is_empty(), "a node refers to what is never hit");
      demand(is_inner_ ? at.reach.contains(box) : at.cell.overlaps(box),
             "a node refers to what is not in it");
      ++times_[i];
    }
  }

  /// None of an inner node's own primitives may fit into a child.
  void check_own(std::span<const std::uint32_t> own, std::uint32_t block, const Aabb& reach) const {
    for (const std::uint32_t i : own) {
      const Aabb box = source_.bounds(i);
      for (std::uint32_t c = 0; c < tree_.axes_.children(); ++c)
        demand(!tree_.part(reach, block, c).contains(box),
               "a child encloses what its parent refers to");
    }
  }

  /// A leaf refers to all that touches it; with `exact` a rim is left out in which bounds of parts
  /// may be off by rounding, on the sides where a primitive reaches beyond the cell.
  void check_leaf(std::span<const std::uint32_t> references, const Aabb& cell,
                  const std::vector<std::uint32_t>& candidates) const {
    for (const std::uint32_t i : candidates) {
      if (std::binary_search(references.begin(), references.end(), i)) continue;
      demand(tree_.options_.exact, "a leaf does not refer to what its cell touches");
      const Aabb box = source_.bounds(i);
      const double rim = 1024 * 0x1p-53 * std::max(norm_max(box.lo), norm_max(box.hi));
      Aabb core = cell;
      for (int axis = 0; axis < 3; ++axis) {
        if (box.lo[axis] < cell.lo[axis]) core.lo[axis] += rim;
        if (box.hi[axis] > cell.hi[axis]) core.hi[axis] -= rim;
      }
      if (core.is_empty()) continue;
      demand(source_.clip(i, core).is_empty(), "a primitive inside a leaf is not referred to");
    }
  }

  std::vector<std::uint32_t> inside(const Aabb& cell,
                                    const std::vector<std::uint32_t>& from) const {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : from)
      if (cell.overlaps(source_.bounds(i))) found.push_back(i);
    return found;
  }

  void check_report(const BuildReport& report) const {
    demand(report.nodes == nodes_, "report: nodes");
    demand(report.leaves == leaves_ && report.empty_leaves == empty_, "report: leaves");
    demand(report.references == next_reference_, "report: references");
    demand(report.depth == static_cast<std::uint64_t>(deepest_), "report: depth");
  }

  const OctantTree& tree_;
  const PrimitiveSource& source_;
  bool is_inner_;
  std::vector<std::uint32_t> times_;
  std::size_t nodes_ = 0, next_reference_ = 0, next_block_ = 0;
  std::uint64_t leaves_ = 0, empty_ = 0;
  int deepest_ = 0;
};

void OctantTree::validate(const PrimitiveSource& source) const {
  OctantChecker(*this, source).run();
}

}  // namespace strahl
