// structures/bih/bih_layout.h - turns a neutral tree of boxes into nodes with two planes each.
#pragma once

#include <vector>

#include <strahl/build/memory_meter.h>
#include <strahl/build/tree.h>
#include <strahl/structures/bih/bih.h>

namespace strahl {

/// Chooses planes and trims; writes nodes depth first, siblings side by side, and counts them in
/// the report. O(nodes). Throws Error{resource}.
class BihLayout {
 public:
  BihLayout(const Tree& tree, const BihOptions& options, MemoryMeter& meter)
      : tree_(tree), options_(options), meter_(meter) {}

  std::vector<BihNode> run();
  const BuildReport& report() const { return report_; }

 private:
  /// A tree node, its place, and the box that the planes above leave of the root's.
  struct Waiting {
    std::uint32_t from;
    std::size_t to;
    Aabb cell;
    std::uint64_t depth;
  };

  std::size_t add_places(std::size_t count);
  void place(Waiting at);
  void trim(Waiting& at);
  void place_leaf(const Waiting& at);
  void place_children(const Waiting& at);
  AxisSide choose_side(const Aabb& cell, const Aabb& box, const AxisSide& usual) const;
  void add_cost(const Aabb& cell, double work);

  const Tree& tree_;
  const BihOptions& options_;
  MemoryMeter& meter_;
  std::vector<BihNode> nodes_;
  std::vector<Waiting> waiting_;
  BuildReport report_;
};

}  // namespace strahl
