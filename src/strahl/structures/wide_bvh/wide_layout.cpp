#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <strahl/build/sah.h>
#include <strahl/build/sort_few.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

constexpr std::size_t kForkReferences = 8192;    // smaller subtrees stay on one thread
constexpr std::size_t kReportReferences = 2048;  // and do not report
constexpr auto kMaxWidth = static_cast<std::size_t>(CollapseRules::kMaxWidth);

/// What a compact tree may take per thing for the sake of exact corners, and how many units it
/// may spend per block: most blocks need two, few with many triangles ten.
constexpr std::uint64_t kCompactBytes = 36;
constexpr std::uint32_t kMostSpare = 10;

/// What is known of a block once it has been looked at, in the place of a subtree's units.
struct BlockPlan {
  std::uint32_t lanes = 0, indexed = 0, rounded = 0;  ///< indexed, rounded: units

  static BlockPlan of(std::uint32_t word) { return {word & 255u, word >> 8 & 255u, word >> 16}; }
  std::uint32_t word() const { return lanes | indexed << 8 | rounded << 16; }
  std::uint32_t units(std::uint32_t spare) const {
    return indexed <= rounded + spare ? indexed : rounded;
  }
};

class Layout {
 public:
  Layout(const Tree& tree, const Collapse& collapse, const WideFrame& box_frame, WideTree& out,
         const PrimitiveSource& source, const BuildContext& context, BuildReport& report)
      : tree_(tree),
        collapse_(collapse),
        box_frame_(box_frame),
        out_(out),
        source_(source),
        context_(context),
        report_(report),
        units_(tree.nodes.size()) {}

  void run() {
    Extent all = measure(0);
    if (out_.layout == WideLayout::compact) all = spend_spare(all);
    if (all.units > kWideMaxUnits)
      throw Error(ErrorCode::resource,
                  out_.layout == WideLayout::full ? "more than 4 GiB of nodes and blocks"
                                                  : "more than 2 GiB of nodes and blocks",
                  "wide_bvh");
    total_units_ = all.units;
    const std::uint64_t bytes = bytes_of(total_units_) + kWideSlack;
    context_.require_memory(bytes, "wide_bvh");
    out_.arena = WideArena(bytes);
    if (collapse_.is_block(0))
      out_.root = write_block(0, 0).id;
    else
      write_node(0, out_.root = 0, true);
    report_.nodes = all.nodes, report_.leaves = all.leaves, report_.references = all.references;
    report_.depth = all.depth, report_.bytes = bytes;
  }

 private:
  using Lanes = std::array<std::uint32_t, kWideMaxLanes>;
  struct Children {
    std::array<std::uint32_t, kMaxWidth> node;
    int count;
    auto begin() const { return node.begin(); }
    auto end() const { return node.begin() + count; }
    std::size_t size() const { return static_cast<std::size_t>(count); }
  };
  /// What a subtree takes, and what is in it. Its first unit is that of a cache line.
  struct Extent {
    std::uint64_t units = 0, nodes = 0, leaves = 0, references = 0, depth = 0;
    void add(const Extent& child) {
      units += child.units, nodes += child.nodes, leaves += child.leaves;
      references += child.references, depth = std::max(depth, child.depth + 1);
    }
  };

  struct Block {
    WideId id;
    Blocking blocking;
  };

  Children children_of(std::uint32_t node) const {
    Children children;
    children.count = collapse_.children(node, children.node);
    return children;
  }

  std::uint64_t bytes_of(std::uint64_t count) const { return count << unit_shift(out_.layout); }
  std::uint64_t units(std::size_t bytes) const { return strahl::units(bytes, out_.layout); }

  /// Nodes begin with a cache line. Compact ones of 224 bytes may begin in the middle of one: they
  /// fill four lines anyway.
  template <class Count>
  Count aligned(Count unit) const {
    const bool may_straddle = out_.layout == WideLayout::compact && out_.width == 8;
    const auto mask = static_cast<Count>(units(may_straddle ? 32 : 64) - 1);
    return (unit + mask) & ~mask;
  }

  /// Calls visit(i) for the children of a node, at once where the node is large.
  template <class Visit>
  void each_child(std::uint32_t node, std::size_t count, Visit visit) const {
    if (collapse_.references(node).size() < kForkReferences) {
      for (std::size_t i = 0; i < count; ++i) visit(i);
      return;
    }
    context_.executor.parallel_for(0, count, 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) visit(i);
    });
  }

  Extent measure(std::uint32_t node) {
    if (collapse_.is_block(node)) return measure_block(node);
    const Children children = children_of(node);
    std::array<Extent, kMaxWidth> extents;
    each_child(node, children.size(),
               [&](std::size_t i) { extents[i] = measure(children.node[i]); });
    Extent all{units(node_bytes(out_.width)), 1, 0, 0, 0};
    for (const bool blocks : {true, false})
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (collapse_.is_block(children.node[i]) != blocks) continue;
        if (!blocks) all.units = aligned(all.units);
        all.add(extents[i]);
      }
    units_[node] = static_cast<std::uint32_t>(all.units);
    return all;
  }

  Extent measure_block(std::uint32_t node) {
    if (units_[node] == 0) units_[node] = plan_of(node).word();
    const BlockPlan plan = BlockPlan::of(units_[node]);
    return {plan.units(spare_), 1, 1, plan.lanes, 0};
  }

  BlockPlan plan_of(std::uint32_t node) const {
    Lanes room;
    const auto references = block_references(node, room);
    const BlockSizes sizes = block_sizes(references, out_, source_);
    return {static_cast<std::uint32_t>(references.size()),
            static_cast<std::uint32_t>(std::min<std::uint64_t>(units(sizes.indexed), 255)),
            static_cast<std::uint32_t>(units(sizes.rounded))};
  }

  /// As many units per block as kCompactBytes per thing allow.
  Extent spend_spare(Extent all) {
    const std::uint64_t allowed = units(kCompactBytes * source_.size());
    while (spare_ < kMostSpare) {
      ++spare_;
      const Extent more = measure(0);
      if (more.units <= allowed) {
        all = more;
        continue;
      }
      --spare_;
      return measure(0);
    }
    return all;
  }

  std::byte* at(std::uint32_t unit) { return out_.arena.data() + bytes_of(unit); }

  /// References of a block, ascending, each once: parts of one primitive may meet again.
  std::span<const std::uint32_t> block_references(std::uint32_t node, Lanes& room) const {
    const std::span<const std::uint32_t> all = collapse_.references(node);
    std::copy(all.begin(), all.end(), room.begin());
    const auto end = room.begin() + static_cast<std::ptrdiff_t>(all.size());
    sort_few(std::span(room).first(all.size()));
    return {room.begin(), std::unique(room.begin(), end)};
  }

  Block write_block(std::uint32_t node, std::uint32_t unit) {
    Lanes room;
    const std::span<const std::uint32_t> references = block_references(node, room);
    const auto lanes = static_cast<std::uint32_t>(references.size());
    std::byte* block = at(unit);
    std::copy(references.begin(), references.end(),
              const_cast<std::uint32_t*>(reference_row(block, lanes, out_.layout)));
    const WrittenBlock written =
        strahl::write_block(block, references, out_, source_, bytes_of(block_units(node)));
    Blocking blocking{written.triangle_area, half_area_of(node),
                      rules_.leaf_cost + rules_.primitive_cost * lanes};
    if (std::isnan(blocking.triangle_area)) blocking.triangle_area = blocking.half_area;
    return {kWideLeaf | unit << 4 | (lanes - 1), blocking};
  }
  std::uint32_t block_units(std::uint32_t node) const {
    return BlockPlan::of(units_[node]).units(spare_);
  }

  /// In the tree's frame.
  double half_area_of(std::uint32_t node) const {
    return tree_.nodes[node].box.half_area() * box_frame_.scale * box_frame_.scale;
  }

  Blocking write_node(std::uint32_t node, std::uint32_t unit, bool is_root) {
    if (is_root || collapse_.references(node).size() >= kReportReferences)
      context_.check(static_cast<double>(unit) / static_cast<double>(total_units_), "laying out");
    const Children children = children_of(node);
    std::byte* const to = at(unit);
    std::array<int, kMaxWidth> slots;
    place(node, children, slots);
    auto* ids = const_cast<WideId*>(child_row(to, out_.width));
    std::array<Blocking, kOrderedWidth> blocking;  // by slot
    std::array<std::uint32_t, kMaxWidth> inner;    // children that are nodes
    std::size_t inner_count = 0;
    std::uint32_t next = unit + static_cast<std::uint32_t>(units(node_bytes(out_.width)));
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (!collapse_.is_block(children.node[i])) {
        inner[inner_count++] = static_cast<std::uint32_t>(i);
        continue;
      }
      const Block block = write_block(children.node[i], next);
      ids[slots[i]] = block.id, blocking[static_cast<std::size_t>(slots[i])] = block.blocking;
      next += block_units(children.node[i]);
    }
    for (std::size_t i = 0; i < inner_count; ++i) {
      next = aligned(next);
      ids[slots[inner[i]]] = next >> finer_ << 4;
      next += units_[children.node[inner[i]]];
    }
    each_child(node, inner_count, [&](std::size_t i) {
      const int slot = slots[inner[i]];
      blocking[static_cast<std::size_t>(slot)] =
          write_node(children.node[inner[i]], ids[slot] >> 4 << finer_, false);
    });
    write_boxes(to, children, slots, blocking);
    return blocking_of(node, blocking);
  }

  Blocking blocking_of(std::uint32_t node, std::span<const Blocking> children) const {
    Blocking all{0.0, half_area_of(node), rules_.node_cost};
    for (const Blocking& child : children) {
      all.triangle_area += child.triangle_area;
      all.cost += child.cost * sah_share(child.half_area, all.half_area);
    }
    return all;
  }

  void place(std::uint32_t node, const Children& children, std::span<int> slots) const {
    std::array<Vec3d, kMaxWidth> centers;
    for (std::size_t i = 0; i < static_cast<std::size_t>(children.count); ++i)
      centers[i] = tree_.nodes[children.node[i]].box.center();
    assign_slots(std::span(centers).first(static_cast<std::size_t>(children.count)),
                 tree_.nodes[node].box.center(), out_.width, slots);
  }

  void write_boxes(std::byte* at, const Children& children, std::span<const int> slots,
                   const std::array<Blocking, kOrderedWidth>& blocking) const {
    clear_boxes(at, out_.width);
    if (out_.width == kOrderedWidth) write_any_order(at, blocking);
    for (std::size_t i = 0; i < static_cast<std::size_t>(children.count); ++i)
      write_box(at, out_.width, slots[i], tree_.nodes[children.node[i]].box, box_frame_);
  }

  const Tree& tree_;
  const CollapseRules rules_;  // what things cost
  const Collapse& collapse_;
  const WideFrame& box_frame_;
  WideTree& out_;
  const PrimitiveSource& source_;
  const BuildContext& context_;
  BuildReport& report_;
  std::uint64_t total_units_ = 0;
  std::uint32_t spare_ = 0;
  const std::uint32_t finer_ =
      kNodeShift - unit_shift(out_.layout);  ///< ids of nodes count coarser
  /// Per node of the tree that becomes a wide one: those of its subtree, or the plan of a block.
  std::vector<std::uint32_t> units_;
};

}  // namespace

WideTree lay_out_wide(const Tree& tree, const Collapse& collapse, const WideFrame& box_frame,
                      WideTree empty, const PrimitiveSource& source, const BuildContext& context,
                      BuildReport& report) {
  WideTree out = std::move(empty);
  Layout(tree, collapse, box_frame, out, source, context, report).run();
  out.depth = report.depth;
  return out;
}

}  // namespace strahl
