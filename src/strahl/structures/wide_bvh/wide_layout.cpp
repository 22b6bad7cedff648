#include <algorithm>
#include <array>
#include <utility>

#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

/// What a compact tree may take per thing for the sake of exact corners, and how many units it
/// may spend per block: most blocks need one, few with many triangles five.
constexpr std::uint64_t kCompactBytes = 36;
constexpr std::size_t kMostSpare = 5;

constexpr auto kMaxWidth = static_cast<std::size_t>(CollapseRules::kMaxWidth);

/// The octant of a slot: bit a set on the high side of axis a.
unsigned octant_of(int slot, int width) { return static_cast<unsigned>(slot) >> (width == 16); }

double fit(const Vec3d& offset, unsigned octant) {
  return ((octant & 1u) != 0 ? offset.x : -offset.x) + ((octant & 2u) != 0 ? offset.y : -offset.y) +
         ((octant & 4u) != 0 ? offset.z : -offset.z);
}

class Layout {
 public:
  Layout(const Tree& tree, const Collapse& collapse, WideTree& out, const PrimitiveSource& source,
         const BuildContext& context, BuildReport& report)
      : tree_(tree),
        collapse_(collapse),
        out_(out),
        source_(source),
        context_(context),
        report_(report) {}

  void run() {
    if (collapse_.is_block(0))
      grow(0);
    else
      measure(0);
    choose_spare();
    if (total_units_ > kWideMaxUnits)
      throw Error(ErrorCode::resource, "more than 4 GiB of nodes and blocks", "wide_bvh");
    const std::uint64_t bytes = total_units_ * kWideUnit + kWideSlack;
    context_.require_memory(bytes, "wide_bvh");
    out_.arena = WideArena(bytes);
    out_.root = collapse_.is_block(0) ? write_block(0, 0) : write_node(0, 0);
    report_.bytes = bytes;
  }

 private:
  using Lanes = std::array<std::uint32_t, kWideMaxLanes>;
  struct Children {
    std::array<std::uint32_t, kMaxWidth> node;
    int count;
    auto begin() const { return node.begin(); }
    auto end() const { return node.begin() + count; }
  };

  Children children_of(std::uint32_t node) const {
    Children children;
    children.count = collapse_.children(node, children.node);
    return children;
  }

  /// Nodes begin with a cache line. Compact ones of 224 bytes need not: they fill four lines
  /// anyway.
  template <class Count>
  Count aligned(Count unit) const {
    if (out_.layout == WideLayout::compact && out_.width == 8) return unit;
    return (unit + 1) / 2 * 2;
  }

  void measure(std::uint32_t node) {
    for (std::uint64_t& total : totals_) total = aligned(total) + units(node_bytes(out_.width));
    for (const bool blocks : {true, false})
      for (const std::uint32_t child : children_of(node)) {
        if (collapse_.is_block(child) != blocks) continue;
        if (blocks)
          grow(child);
        else
          measure(child);
      }
  }

  /// By a block. All totals are the same in the full layout.
  void grow(std::uint32_t block) {
    Lanes room;
    const auto references = block_references(block, room);
    const BlockSizes sizes = block_sizes(references, out_, source_);
    for (std::size_t spare = 0; spare <= kMostSpare; ++spare)
      totals_[spare] += units(sizes.bytes(spare));
  }

  /// As many as kCompactBytes per thing allow.
  void choose_spare() {
    const std::uint64_t allowed = kCompactBytes * source_.size() / kWideUnit;
    while (spare_ < kMostSpare && totals_[spare_ + 1] <= allowed) ++spare_;
    total_units_ = totals_[spare_];
  }

  std::byte* take(std::size_t bytes, std::uint32_t& unit) {
    unit = next_unit_;
    next_unit_ += static_cast<std::uint32_t>(units(bytes));
    return out_.arena.data() + std::size_t{unit} * kWideUnit;
  }

  /// References of a block, ascending, each once: parts of one primitive may meet again.
  std::span<const std::uint32_t> block_references(std::uint32_t node, Lanes& room) const {
    const std::span<const std::uint32_t> all = collapse_.references(node);
    std::copy(all.begin(), all.end(), room.begin());
    const auto end = room.begin() + static_cast<std::ptrdiff_t>(all.size());
    std::sort(room.begin(), end);
    return {room.begin(), std::unique(room.begin(), end)};
  }

  WideId write_block(std::uint32_t node, std::uint64_t depth) {
    Lanes room;
    const std::span<const std::uint32_t> references = block_references(node, room);
    const auto lanes = static_cast<std::uint32_t>(references.size());
    std::uint32_t unit;
    const std::size_t bytes = block_sizes(references, out_, source_).bytes(spare_);
    std::byte* block = take(bytes, unit);
    std::copy(references.begin(), references.end(),
              const_cast<std::uint32_t*>(reference_row(block, lanes, out_.layout)));
    strahl::write_block(block, references, out_, source_, bytes);
    ++report_.nodes, ++report_.leaves, report_.references += lanes;
    report_.depth = std::max(report_.depth, depth);
    return kWideLeaf | unit << 4 | (lanes - 1);
  }

  WideId write_node(std::uint32_t node, std::uint64_t depth) {
    if (report_.nodes % 4096 == 0)
      context_.check(static_cast<double>(next_unit_) / static_cast<double>(total_units_),
                     "laying out");
    ++report_.nodes;
    const Children children = children_of(node);
    std::uint32_t unit;
    next_unit_ = aligned(next_unit_);
    std::byte* at = take(node_bytes(out_.width), unit);
    std::array<int, kMaxWidth> slots;
    place(node, children, slots);
    write_boxes(at, children, slots);
    auto* ids = const_cast<WideId*>(child_row(at, out_.width));
    for (const bool blocks : {true, false})
      for (std::size_t i = 0; i < static_cast<std::size_t>(children.count); ++i) {
        const std::uint32_t child = children.node[i];
        if (collapse_.is_block(child) != blocks) continue;
        ids[slots[i]] = blocks ? write_block(child, depth + 1) : write_node(child, depth + 1);
      }
    return unit;
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
      write_box(at, out_.width, slots[i], tree_.nodes[children.node[i]].box, out_.frame);
  }

  const Tree& tree_;
  const Collapse& collapse_;
  WideTree& out_;
  const PrimitiveSource& source_;
  const BuildContext& context_;
  BuildReport& report_;
  std::array<std::uint64_t, kMostSpare + 1> totals_{};  ///< per spare
  std::uint64_t total_units_ = 0, spare_ = 0;
  std::uint32_t next_unit_ = 0;
};

/// Slots of a node's children: the best fitting pair of child and slot first, then exchanges.
class SlotChoice {
 public:
  SlotChoice(std::span<const Vec3d> centers, const Vec3d& middle, int width, std::span<int> slots)
      : slots_(slots),
        width_(width),
        count_(centers.size()),
        free_((std::uint32_t{1} << width) - 1) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3d offset = centers[i] - middle;
      least_gain_[i] = kLeastGain * norm1(offset);
      for (unsigned octant = 0; octant < 8; ++octant) fits_[i][octant] = fit(offset, octant);
    }
  }

  void fill() {
    for (std::uint32_t left = (1u << count_) - 1; left != 0;) {
      double best = -Aabb::kInf;
      std::size_t best_child = 0;
      int best_slot = -1;
      for (std::size_t child = 0; child < count_; ++child) {
        if ((left >> child & 1u) == 0) continue;
        for (int slot = 0; slot < width_; ++slot) {
          if (!is_free(slot)) continue;
          const double gain = fit_of(child, slot);
          if (best_slot >= 0 && !(gain > best)) continue;
          best = gain, best_child = child, best_slot = slot;
        }
      }
      slots_[best_child] = best_slot;
      left &= ~(1u << best_child), free_ &= ~(1u << best_slot);
    }
  }

  /// Exchanges and moves as long as they fit better; those that fill() took last had little choice.
  void improve() {
    bool is_better = true;
    for (int round = 0; round < kMostRounds && is_better; ++round) {
      is_better = false;
      for (std::size_t a = 0; a < count_; ++a) {
        for (std::size_t b = a + 1; b < count_; ++b) is_better |= exchange(a, b);
        for (int slot = 0; slot < width_; ++slot) is_better |= is_free(slot) && move(a, slot);
      }
    }
  }

 private:
  static constexpr int kMostRounds = 8;
  static constexpr double kLeastGain = 1e-6;  ///< relative: roundings are no gain

  bool is_free(int slot) const { return (free_ >> slot & 1u) != 0; }
  double fit_of(std::size_t child, int slot) const { return fits_[child][octant_of(slot, width_)]; }

  bool exchange(std::size_t a, std::size_t b) {
    const double now = fit_of(a, slots_[a]) + fit_of(b, slots_[b]);
    const double then = fit_of(a, slots_[b]) + fit_of(b, slots_[a]);
    if (!(then > now + least_gain_[a] + least_gain_[b])) return false;
    std::swap(slots_[a], slots_[b]);
    return true;
  }
  bool move(std::size_t a, int slot) {
    const double now = fit_of(a, slots_[a]);
    if (!(fit_of(a, slot) > now + least_gain_[a])) return false;
    free_ ^= 1u << slot | 1u << slots_[a];
    slots_[a] = slot;
    return true;
  }

  std::span<int> slots_;
  int width_;
  std::size_t count_;
  std::uint32_t free_;
  std::array<std::array<double, 8>, kMaxWidth> fits_;  ///< of each child into each octant
  std::array<double, kMaxWidth> least_gain_;
};

}  // namespace

void assign_slots(std::span<const Vec3d> centers, const Vec3d& middle, int width,
                  std::span<int> slots) {
  SlotChoice choice(centers, middle, width, slots);
  choice.fill();
  choice.improve();
}

WideTree lay_out_wide(const Tree& tree, const Collapse& collapse, WideTree empty,
                      const PrimitiveSource& source, const BuildContext& context,
                      BuildReport& report) {
  WideTree out = std::move(empty);
  Layout(tree, collapse, out, source, context, report).run();
  out.depth = report.depth;
  return out;
}

}  // namespace strahl
