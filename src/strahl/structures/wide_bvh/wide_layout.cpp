#include <algorithm>
#include <array>
#include <vector>

#include <strahl/build/sort_few.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

constexpr std::size_t kForkReferences = 8192;    // smaller subtrees stay on one thread
constexpr std::size_t kReportReferences = 2048;  // and do not report
constexpr auto kMaxWidth = static_cast<std::size_t>(CollapseRules::kMaxWidth);

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
    const bool is_block = collapse_.is_block(0);
    const Extent all = is_block ? measure_block(0) : measure(0);
    if (all.units > kWideMaxUnits)
      throw Error(ErrorCode::resource, "more than 4 GiB of nodes and blocks", "wide_bvh");
    total_units_ = all.units;
    const std::uint64_t bytes = total_units_ * kWideUnit + kWideSlack;
    context_.require_memory(bytes, "wide_bvh");
    out_.arena = WideArena(bytes);
    if (is_block)
      out_.root = write_block(0, 0);
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

  Children children_of(std::uint32_t node) const {
    Children children;
    children.count = collapse_.children(node, children.node);
    return children;
  }

  /// Nodes begin with a cache line.
  template <class Count>
  static Count aligned(Count unit) {
    return (unit + 1) / 2 * 2;
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
    const Children children = children_of(node);
    std::array<Extent, kMaxWidth> extents;
    each_child(node, children.size(), [&](std::size_t i) {
      const std::uint32_t child = children.node[i];
      extents[i] = collapse_.is_block(child) ? measure_block(child) : measure(child);
    });
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

  Extent measure_block(std::uint32_t node) const {
    Lanes room;
    const std::size_t lanes = block_references(node, room).size();
    return {units(leaf_bytes(lanes)), 1, 1, lanes, 0};
  }

  std::byte* at(std::uint32_t unit) { return out_.arena.data() + std::size_t{unit} * kWideUnit; }

  /// References of a block, ascending, each once: parts of one primitive may meet again.
  std::span<const std::uint32_t> block_references(std::uint32_t node, Lanes& room) const {
    const std::span<const std::uint32_t> all = collapse_.references(node);
    std::copy(all.begin(), all.end(), room.begin());
    const auto end = room.begin() + static_cast<std::ptrdiff_t>(all.size());
    sort_few(std::span(room).first(all.size()));
    return {room.begin(), std::unique(room.begin(), end)};
  }

  WideId write_block(std::uint32_t node, std::uint32_t unit) {
    Lanes room;
    const std::span<const std::uint32_t> references = block_references(node, room);
    const auto lanes = static_cast<std::uint32_t>(references.size());
    std::byte* block = at(unit);
    std::copy(references.begin(), references.end(),
              const_cast<std::uint32_t*>(reference_row(block, lanes)));
    strahl::write_block(block, references, out_.frame, source_);
    return kWideLeaf | unit << 4 | (lanes - 1);
  }

  void write_node(std::uint32_t node, std::uint32_t unit, bool is_root) {
    if (is_root || collapse_.references(node).size() >= kReportReferences)
      context_.check(static_cast<double>(unit) / static_cast<double>(total_units_), "laying out");
    const Children children = children_of(node);
    std::byte* const to = at(unit);
    std::array<int, kMaxWidth> slots;
    place(node, children, slots);
    write_boxes(to, children, slots);
    auto* ids = const_cast<WideId*>(child_row(to, out_.width));
    std::array<std::uint32_t, kMaxWidth> inner;  // children that are nodes
    std::size_t inner_count = 0;
    std::uint32_t next = unit + static_cast<std::uint32_t>(units(node_bytes(out_.width)));
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (!collapse_.is_block(children.node[i])) {
        inner[inner_count++] = static_cast<std::uint32_t>(i);
        continue;
      }
      ids[slots[i]] = write_block(children.node[i], next);
      next += static_cast<std::uint32_t>(units(leaf_bytes(lanes_of(ids[slots[i]]))));
    }
    for (std::size_t i = 0; i < inner_count; ++i) {
      next = aligned(next);
      ids[slots[inner[i]]] = next;
      next += units_[children.node[inner[i]]];
    }
    each_child(node, inner_count, [&](std::size_t i) {
      write_node(children.node[inner[i]], ids[slots[inner[i]]], false);
    });
  }

  void place(std::uint32_t node, const Children& children, std::span<int> slots) const {
    std::array<Vec3d, kMaxWidth> centers;
    for (std::size_t i = 0; i < static_cast<std::size_t>(children.count); ++i)
      centers[i] = tree_.nodes[children.node[i]].box.center();
    assign_slots(std::span(centers).first(static_cast<std::size_t>(children.count)),
                 tree_.nodes[node].box.center(), out_.width, slots);
  }

  void write_boxes(std::byte* at, const Children& children, std::span<const int> slots) const {
    clear_boxes(at, out_.width);
    for (std::size_t i = 0; i < static_cast<std::size_t>(children.count); ++i)
      write_box(at, out_.width, slots[i], tree_.nodes[children.node[i]].box, box_frame_);
  }

  const Tree& tree_;
  const Collapse& collapse_;
  const WideFrame& box_frame_;
  WideTree& out_;
  const PrimitiveSource& source_;
  const BuildContext& context_;
  BuildReport& report_;
  std::uint64_t total_units_ = 0;
  std::vector<std::uint32_t> units_;  ///< per node of the tree that becomes a wide one: its subtree
};

}  // namespace

WideTree lay_out_wide(const Tree& tree, const Collapse& collapse, int width, const WideFrame& frame,
                      const WideFrame& box_frame, bool has_exact_corners,
                      const PrimitiveSource& source, const BuildContext& context,
                      BuildReport& report) {
  WideTree out;
  out.width = width, out.frame = frame, out.has_exact_corners = has_exact_corners;
  Layout(tree, collapse, box_frame, out, source, context, report).run();
  out.depth = report.depth;
  return out;
}

}  // namespace strahl
