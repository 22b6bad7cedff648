// structures/ray_classification/ray_classification_validate.cpp - what can be seen of the cells at
// one moment: the report, and the invariants, executable.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <strahl/build/sah.h>
#include <strahl/structures/ray_classification/ray_classification.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("ray_classification: ") + broken);
}

}  // namespace

/// Goes through the cells as a reader: others may add and evict meanwhile.
class RayClassificationChecker {
 public:
  explicit RayClassificationChecker(const RayClassification& own)
      : own_(own), reading_(own.cells_->reader()) {}

  BuildReport report() {
    for (std::size_t i = 0; i < own_.cells_->root_count(); ++i) report_below(root(i), 0);
    report_.bytes = own_.candidates_.bytes() + own_.cells_->figures().bytes;
    report_.sah_cost = sah_cost();
    return report_;
  }

  void run() {
    for (int culls = 0; culls < 2; ++culls)
      for (int face = 0; face < kFaces; ++face) {
        const CellCache::Cell& at = root(RayClassification::root_of(face, culls != 0));
        const auto all = own_.candidates_.order(face);
        demand(std::ranges::equal(at.list(), all), "the list of a root is not of all groups");
        check_below(at, own_.candidates_.space().root(), face, culls != 0, 0);
      }
    demand(own_.cells_->figures().bytes <= own_.cells_->budget(), "more bytes than the budget");
  }

 private:
  const CellCache::Cell& root(std::size_t i) const { return own_.cells_->root(i); }

  void report_below(const CellCache::Cell& cell, std::uint64_t depth) {
    ++report_.nodes;
    report_.depth = std::max(report_.depth, depth);
    bool is_leaf = true;
    for (unsigned i = 0; i < RayCell::kChildren; ++i)
      if (const CellCache::Cell* child = cell.child(i))
        is_leaf = false, report_below(*child, depth + 1);
    if (!is_leaf) return;
    ++report_.leaves;
    report_.empty_leaves += cell.list().empty();
    for (const std::uint32_t i : cell.list()) report_.references += own_.candidates_.group(i).count;
  }

  /// Of a line through the scene's box that finds no cells yet: every group's box is tested.
  double sah_cost() const {
    const double whole = own_.candidates_.space().box().half_area();
    double sum = 0.0;
    for (const CandidateGroup& group : own_.candidates_.groups()) {
      const double share = whole < Aabb::kInf ? sah_share(group.box.half_area(), whole) : 1.0;
      sum += 1.0 + share * group.count;
    }
    return sum;
  }

  void check_below(const CellCache::Cell& cell, const RayCell& space, int face, bool culls,
                   int depth) {
    for (unsigned i = 0; i < RayCell::kChildren; ++i) {
      const CellCache::Cell* child = cell.child(i);
      if (child == nullptr) continue;
      demand(own_.is_divided(cell, depth), "a cell that needs no children has some");
      const RayCell below = space.child(i);
      std::vector<std::uint32_t> expected;
      own_.candidates_.filter(cell.list(), Beam(below, face), culls, expected);
      demand(std::ranges::equal(child->list(), expected),
             "a list is not that of the parent, filtered");
      check_below(*child, below, face, culls, depth + 1);
    }
  }

  const RayClassification& own_;
  Epochs::Reader reading_;
  BuildReport report_;
};

BuildReport RayClassification::report() const {
  return cells_ ? RayClassificationChecker(*this).report() : BuildReport{};
}

void RayClassification::validate(const PrimitiveSource& source) const {
  candidates_.validate(source);
  if (cells_) RayClassificationChecker(*this).run();
}

}  // namespace strahl
