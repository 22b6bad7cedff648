#include <algorithm>
#include <vector>

#include <strahl/build/optimise.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = LinkedNode::kNone;
constexpr std::size_t kGrain = 256;

/// What moving a node beside the target promises to lower the sum by.
struct Move {
  double gain = 0.0;
  std::uint32_t node = kNone, target = kNone;
};

class Reinsertion {
 public:
  Reinsertion(LinkedTree& tree, const BuildContext& context)
      : tree_(tree), nodes_(tree.nodes), context_(context) {}

  /// @returns what the round lowered the sum by
  double round() {
    std::vector<Move> moves(nodes_.size());
    context_.executor.parallel_for(0, moves.size(), kGrain, [&](std::size_t from, std::size_t to) {
      std::vector<Candidate> waiting;
      for (std::size_t i = from; i < to; ++i)
        moves[i] = search(static_cast<std::uint32_t>(i), waiting);
    });
    std::erase_if(moves, [](const Move& move) { return move.target == kNone; });
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
    });
    double gain = 0.0;
    for (const Move& move : moves) gain += carry_out(move);
    return gain;
  }

 private:
  /// A subtree to look at, and what is gained as long as the node is not put anywhere.
  struct Candidate {
    double gain;
    std::uint32_t node;
  };

  double area(std::uint32_t node) const { return nodes_[node].box.half_area(); }

  /// Takes the node out in thought: its sibling replaces the parent, ancestors shrink. At each
  /// ancestor the subtree beside the path is searched.
  Move search(std::uint32_t node, std::vector<Candidate>& waiting) const {
    const std::uint32_t parent = nodes_[node].parent;
    Move best{0.0, node, kNone};
    if (parent == kNone) return best;
    double gain = area(parent);
    std::uint32_t beside = nodes_[parent].sibling_of(node);
    Aabb shrunken = nodes_[beside].box;  // of the ancestor, without the node
    for (std::uint32_t pivot = parent;;) {
      search_below({gain, beside}, waiting, best);
      if (pivot != parent) {
        shrunken.extend(nodes_[beside].box);
        gain += area(pivot) - shrunken.half_area();
      }
      const std::uint32_t next = nodes_[pivot].parent;
      if (next == kNone) break;
      beside = nodes_[next].sibling_of(pivot);
      pivot = next;
    }
    if (best.target == nodes_[parent].sibling_of(node)) best.target = kNone;
    return best;
  }

  void search_below(Candidate from, std::vector<Candidate>& waiting, Move& best) const {
    const Aabb& box = nodes_[best.node].box;
    const double least = box.half_area();
    waiting.assign(1, from);
    while (!waiting.empty()) {
      const Candidate at = waiting.back();
      waiting.pop_back();
      if (at.gain - least <= best.gain) continue;
      const LinkedNode& node = nodes_[at.node];
      const double joined = Aabb::join(node.box, box).half_area();
      if (at.gain - joined > best.gain) best.gain = at.gain - joined, best.target = at.node;
      if (node.is_leaf()) continue;
      const double below = at.gain + node.box.half_area() - joined;
      waiting.push_back({below, node.left});
      waiting.push_back({below, node.right});
    }
  }

  /// Earlier moves may have changed what this one promised.
  /// @returns what it lowered the sum by
  double carry_out(const Move& move) {
    const std::uint32_t parent = nodes_[move.node].parent;
    if (move.node == tree_.root || move.target == parent) return 0.0;
    const std::uint32_t sibling = nodes_[parent].sibling_of(move.node);
    if (move.target == sibling || is_below(move.target, move.node)) return 0.0;
    const double gain = put_beside(move.node, move.target);
    if (gain > 0.0) return gain;
    put_beside(move.node, sibling);
    return 0.0;
  }

  bool is_below(std::uint32_t node, std::uint32_t ancestor) const {
    while (node != kNone && node != ancestor) node = nodes_[node].parent;
    return node == ancestor;
  }

  /// The node's parent goes with it and becomes the parent of both.
  double put_beside(std::uint32_t node, std::uint32_t target) {
    const std::uint32_t parent = nodes_[node].parent, above = nodes_[parent].parent;
    double gain = area(parent);
    tree_.replace_child(parent, nodes_[parent].sibling_of(node));
    gain += refit(above);
    tree_.replace_child(target, parent);
    nodes_[parent].left = target, nodes_[parent].right = node;
    nodes_[target].parent = parent;
    nodes_[parent].box = Aabb::join(nodes_[target].box, nodes_[node].box);
    gain -= area(parent);
    return gain + refit(nodes_[parent].parent);
  }

  /// @returns by how much boxes shrank
  double refit(std::uint32_t node) {
    double shrunk = 0.0;
    for (; node != kNone; node = nodes_[node].parent) {
      LinkedNode& n = nodes_[node];
      const Aabb box = Aabb::join(nodes_[n.left].box, nodes_[n.right].box);
      if (n.box == box) break;
      shrunk += n.box.half_area() - box.half_area();
      n.box = box;
    }
    return shrunk;
  }

  LinkedTree& tree_;
  std::vector<LinkedNode>& nodes_;
  const BuildContext& context_;
};

}  // namespace

void reinsert_nodes(LinkedTree& tree, const ReinsertionRules& rules, const BuildContext& context) {
  if (tree.nodes.size() < 5) return;  // fewer than three leaves
  Reinsertion reinsertion(tree, context);
  for (int round = 0; round < rules.rounds; ++round) {
    context.check(static_cast<double>(round) / rules.rounds, "reinserting");
    if (reinsertion.round() <= rules.least_gain * tree.inner_area()) return;
  }
}

}  // namespace strahl
