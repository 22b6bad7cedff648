#include <array>
#include <atomic>
#include <cstring>
#include <utility>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/collapse.h>
#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_refit.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr int kForkDepth = 3;  // up to 8^3 subtrees at once

/// Boxes of all things, and what they have in common.
struct MovedThings {
  std::vector<Aabb> boxes;
  Aabb whole;
  bool all_floats = true;
};

MovedThings bound_all(const PrimitiveSource& source, const BuildContext& context) {
  MovedThings things;
  things.boxes.resize(source.size());
  std::atomic<bool> all_floats{true};
  context.executor.parallel_for(0, things.boxes.size(), kGrain,
                                [&](std::size_t from, std::size_t to) {
                                  context.check(0.0, "fitting");
                                  bool are_floats = true;
                                  for (std::size_t i = from; i < to; ++i) {
                                    TriangleVertices corners;
                                    things.boxes[i] = source.bounds(static_cast<std::uint32_t>(i));
                                    if (source.triangle(static_cast<std::uint32_t>(i), corners))
                                      are_floats = are_floats && has_float_corners(corners);
                                  }
                                  if (!are_floats) all_floats = false;
                                });
  for (const Aabb& box : things.boxes) things.whole.extend(box);
  things.all_floats = all_floats;
  return things;
}

class Fitter {
 public:
  Fitter(WideTree& tree, const MovedThings& things, const PrimitiveSource& source,
         const BuildContext& context)
      : tree_(tree), things_(things), source_(source), context_(context) {}

  /// @returns the cost
  double run() { return fit(tree_.root, 0).cost; }
  /// Whether each block is no larger than it was; compact ones may be.
  bool all_fit() const { return all_fit_; }

 private:
  struct Fitted {
    Aabb box;
    double cost = 0.0;
  };

  double share(const Aabb& box) const {
    return sah_share(box.half_area(), things_.whole.half_area());
  }

  Fitted fit(WideId id, int depth) { return is_leaf(id) ? fit_block(id) : fit_node(id, depth); }

  /// Bytes of a block up to the next one.
  std::size_t room(const std::byte* block, std::uint32_t lanes) const {
    const std::size_t bytes = is_compact(block) ? compact_bytes(block, lanes) : leaf_bytes(lanes);
    return units(bytes, tree_.layout) << unit_shift(tree_.layout);
  }

  Fitted fit_block(WideId id) {
    std::byte* block = tree_.at(id);
    const std::uint32_t lanes = lanes_of(id);
    const std::span references(reference_row(block, lanes), lanes);
    Fitted fitted;
    for (const std::uint32_t reference : references) fitted.box.extend(things_.boxes[reference]);
    if (!write_block(block, references, tree_, source_, room(block, lanes)).fits) all_fit_ = false;
    fitted.cost = share(fitted.box) * (rules_.leaf_cost + rules_.primitive_cost * lanes);
    return fitted;
  }

  Fitted fit_node(WideId id, int depth) {
    std::byte* node = tree_.at(id);
    std::array<Fitted, CollapseRules::kMaxWidth> children;
    std::array<int, CollapseRules::kMaxWidth> slots;
    std::size_t used = 0;
    for (int slot = 0; slot < tree_.width; ++slot)
      if (plane_row(node, tree_.width, 0)[slot] <= plane_row(node, tree_.width, 3)[slot])
        slots[used++] = slot;
    const auto fit_some = [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i)
        children[i] = fit(child_row(node, tree_.width)[slots[i]], depth + 1);
    };
    if (depth < kForkDepth) {
      context_.check(0.5, "fitting");
      context_.executor.parallel_for(0, used, 1, fit_some);
    } else {
      fit_some(0, used);
    }
    Fitted fitted;
    for (std::size_t i = 0; i < used; ++i) {
      fitted.box.extend(children[i].box), fitted.cost += children[i].cost;
      write_box(node, tree_.width, slots[i], children[i].box, tree_.frame);
    }
    fitted.cost += share(fitted.box) * rules_.node_cost;
    return fitted;
  }

  WideTree& tree_;
  const MovedThings& things_;
  const PrimitiveSource& source_;
  const BuildContext& context_;
  CollapseRules rules_;
  std::atomic<bool> all_fit_{true};
};

/// Marks what the blocks refer to.
void mark_things(const WideTree& tree, WideId id, std::vector<std::uint8_t>& is_known) {
  if (is_leaf(id)) {
    const std::uint32_t lanes = lanes_of(id);
    const std::uint32_t* references = reference_row(tree.at(id), lanes);
    for (std::uint32_t i = 0; i < lanes; ++i) is_known[references[i]] = 1;
    return;
  }
  const std::byte* node = tree.at(id);
  for (int slot = 0; slot < tree.width; ++slot)
    if (plane_row(node, tree.width, 0)[slot] <= plane_row(node, tree.width, 3)[slot])
      mark_things(tree, child_row(node, tree.width)[slot], is_known);
}

bool holds_the_same(const WideTree& tree, const std::vector<Aabb>& boxes) {
  std::vector<std::uint8_t> is_known(boxes.size());
  mark_things(tree, tree.root, is_known);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].is_empty() == (is_known[i] != 0)) return false;
  return true;
}

}  // namespace

std::optional<FittedWideTree> fit_wide_tree(const WideTree& tree, const PrimitiveSource& source,
                                            const BuildContext& context) {
  if (tree.is_empty()) return std::nullopt;
  context.require_memory(2 * tree.arena.size() + std::uint64_t{source.size()} * (sizeof(Aabb) + 1),
                         "wide_bvh");
  const MovedThings things = bound_all(source, context);
  if (!holds_the_same(tree, things.boxes)) return std::nullopt;
  FittedWideTree fitted;
  WideTree& out = fitted.tree;
  out.arena = WideArena(tree.arena.size());
  std::memcpy(out.arena.data(), tree.arena.data(), tree.arena.size());
  out.root = tree.root, out.width = tree.width, out.depth = tree.depth;
  out.layout = tree.layout;
  out.frame = make_wide_frame(things.whole);
  out.has_exact_corners = things.all_floats && out.frame.is_identity();
  Fitter fitter(out, things, source, context);
  fitted.cost = fitter.run();
  if (!fitter.all_fit()) return std::nullopt;
  return fitted;
}

}  // namespace strahl
