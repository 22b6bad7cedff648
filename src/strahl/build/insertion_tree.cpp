#include <algorithm>
#include <bit>
#include <numeric>
#include <queue>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/build/insertion_tree.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr int kSpareLevels = 8;  ///< beyond a balanced tree's, for what is divided anew

/// Leaves have a reference and no children, which are a list.
struct Node {
  Aabb box;
  double area = 0.0;
  std::uint32_t parent = kNone, first_child = kNone, next = kNone;
  std::uint32_t children = 0, leaves = 1, reference = 0;
  int height = 0;

  bool is_leaf() const { return children == 0; }
};

/// A place for a primitive: beside a node, or below it.
struct Place {
  double cost = Aabb::kInf;
  std::uint32_t node = kNone;
  bool is_below = false;
};

class Grower {
 public:
  Grower(std::span<const PrimRef> refs, const InsertionRules& rules) : refs_(refs), rules_(rules) {
    nodes_.reserve(2 * refs.size());
  }

  void insert(std::uint32_t i) {
    const std::uint32_t leaf = take_node();
    nodes_[leaf].box = refs_[i].box;
    nodes_[leaf].area = refs_[i].box.half_area();
    nodes_[leaf].reference = i;
    if (root_ == kNone) {
      root_ = leaf;
      return;
    }
    const Place place = rules_.search == InsertSearch::branch_and_bound ? search_all(refs_[i].box)
                                                                        : search_path(refs_[i].box);
    if (place.is_below)
      add_child(place.node, leaf);
    else
      add_sibling(place.node, leaf);
    refresh_upwards(nodes_[leaf].parent, refs_[i].box);
    if (nodes_[root_].height > rules_.max_depth) mend_depth();
  }

  Hierarchy finish() const;

 private:
  std::vector<std::uint8_t> choose_leaves() const;
  void list(std::uint32_t node, std::vector<std::uint32_t>& references) const;

  double grown(std::uint32_t node, const Aabb& box) const {
    return Aabb::join(nodes_[node].box, box).half_area();
  }
  double growth_cost(const Node& node, double area) const {
    return (area - node.area) * static_cast<double>(node.children);
  }
  bool has_room(const Node& node) const {
    return !node.is_leaf() && node.children < rules_.max_children;
  }

  /// The cheaper of both places at a node, without what is inherited.
  Place place_at(std::uint32_t node, double area) const {
    const Place beside{2.0 * area, node, false};
    if (!has_room(nodes_[node])) return beside;
    const Place below{growth_cost(nodes_[node], area) + area, node, true};
    return below.cost <= beside.cost ? below : beside;
  }

  template <class Visit>
  void for_children(std::uint32_t node, Visit visit) const {
    for (std::uint32_t c = nodes_[node].first_child; c != kNone; c = nodes_[c].next) visit(c);
  }

  /// Equal costs go to the deeper place, so that equal boxes do not make a chain.
  Place search_path(const Aabb& box) const {
    Place best;
    double inherited = 0.0;
    for (std::uint32_t at = root_; inherited <= best.cost;) {
      const Node& node = nodes_[at];
      const double area = grown(at, box);
      Place here = place_at(at, area);
      here.cost += inherited;
      if (here.cost <= best.cost) best = here;
      if (node.is_leaf()) break;
      if (ends_descent(at, box, area)) return {here.cost, at, true};
      inherited += growth_cost(node, area);
      at = choose_child(at, box);
    }
    return best;
  }

  bool ends_descent(std::uint32_t node, const Aabb& box, double area) const {
    if (rules_.search == InsertSearch::branch_and_bound || !has_room(nodes_[node])) return false;
    bool all = true;
    for_children(
        node, [&](std::uint32_t c) { all = all && grown(c, box) >= rules_.attach_share * area; });
    return all;
  }

  /// Ties go to the child with fewer leaves, then to the earlier one.
  std::uint32_t choose_child(std::uint32_t node, const Aabb& box) const {
    std::uint32_t best = kNone;
    double best_cost = Aabb::kInf;
    for_children(node, [&](std::uint32_t c) {
      const double area = grown(c, box);
      const double cost =
          rules_.search == InsertSearch::growth ? area - nodes_[c].area : place_at(c, area).cost;
      if (best != kNone && cost > best_cost) return;
      if (best != kNone && cost == best_cost && nodes_[c].leaves >= nodes_[best].leaves) return;
      best = c, best_cost = cost;
    });
    return best;
  }

  /// Best first by inherited cost, cheaper than what one path finds. Every place below a node costs
  /// at least the primitive's area more.
  Place search_all(const Aabb& box) {
    const double least = box.half_area();
    Place best = search_path(box);
    waiting_.clear();
    waiting_.push_back({0.0, 0, root_});
    std::uint32_t visits = 0, pushed = 0;
    while (!waiting_.empty() && visits++ < kMaxInsertVisits) {
      std::pop_heap(waiting_.begin(), waiting_.end());
      const Waiting at = waiting_.back();
      waiting_.pop_back();
      if (at.inherited + least >= best.cost) break;
      const double area = grown(at.node, box);
      Place here = place_at(at.node, area);
      here.cost += at.inherited;
      if (here.cost < best.cost) best = here;
      const double inherited = at.inherited + growth_cost(nodes_[at.node], area);
      if (inherited + least >= best.cost) continue;
      for_children(at.node, [&](std::uint32_t c) {
        waiting_.push_back({inherited, ++pushed, c});
        std::push_heap(waiting_.begin(), waiting_.end());
      });
    }
    return best;
  }

  std::uint32_t take_node() {
    if (!free_.empty()) {
      const std::uint32_t node = free_.back();
      free_.pop_back();
      nodes_[node] = {};
      return node;
    }
    nodes_.emplace_back();
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  void add_child(std::uint32_t parent, std::uint32_t child) {
    std::uint32_t* link = &nodes_[parent].first_child;
    while (*link != kNone) link = &nodes_[*link].next;
    *link = child;
    nodes_[child].parent = parent, nodes_[child].next = kNone;
    ++nodes_[parent].children;
  }

  /// A new inner node takes the place of `node` and holds both.
  void add_sibling(std::uint32_t node, std::uint32_t leaf) {
    const std::uint32_t pair = take_node(), parent = nodes_[node].parent;
    Node& fresh = nodes_[pair];
    fresh.box = nodes_[node].box, fresh.leaves = nodes_[node].leaves;
    fresh.parent = parent, fresh.next = nodes_[node].next;
    if (parent == kNone) {
      root_ = pair;
    } else {
      std::uint32_t* link = &nodes_[parent].first_child;
      while (*link != node) link = &nodes_[*link].next;
      *link = pair;
    }
    add_child(pair, node);
    add_child(pair, leaf);
    fresh.height = nodes_[node].height + 1;
  }

  /// The inserted leaf is not counted yet from `node` up.
  void refresh_upwards(std::uint32_t node, const Aabb& box) {
    int height = 0;
    for (std::uint32_t at = node; at != kNone; at = nodes_[at].parent) {
      Node& n = nodes_[at];
      n.box.extend(box);
      n.area = n.box.half_area();
      ++n.leaves;
      height = n.height = std::max(n.height, height + 1);
    }
  }

  void mend_depth();
  void divide_anew(std::uint32_t node, int levels);

  struct Waiting {
    double inherited;
    std::uint32_t number, node;
    bool operator<(const Waiting& o) const {
      return inherited != o.inherited ? inherited > o.inherited : number > o.number;
    }
  };

  std::span<const PrimRef> refs_;
  const InsertionRules& rules_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;
  std::vector<Waiting> waiting_;
  std::uint32_t root_ = kNone;
};

/// Goes down to the deepest leaf as long as there are levels to spare.
void Grower::mend_depth() {
  std::uint32_t at = root_;
  for (int levels = rules_.max_depth;; --levels) {
    std::uint32_t deepest = kNone;
    for_children(at, [&](std::uint32_t c) {
      if (deepest == kNone || nodes_[c].height > nodes_[deepest].height) deepest = c;
    });
    const int needed = static_cast<int>(std::bit_width(nodes_[deepest].leaves - 1)) + kSpareLevels;
    if (levels - 1 < needed) return divide_anew(at, levels);
    at = deepest;
  }
}

void Grower::divide_anew(std::uint32_t node, int levels) {
  std::vector<PrimRef> leaves;
  std::vector<std::uint32_t> waiting{node};
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    if (nodes_[at].is_leaf()) leaves.push_back({nodes_[at].box, at});
    for_children(at, [&](std::uint32_t c) { waiting.push_back(c); });
    if (at != node && !nodes_[at].is_leaf()) free_.push_back(at);
  }
  // Levels are kept for what comes next, or it would be divided anew for every primitive.
  const int few = static_cast<int>(std::bit_width(leaves.size() - 1)) + kSpareLevels / 4;
  const auto splitter = make_sweep_splitter(leaves, rules_.cost);
  const Tree tree = build_object_tree(*splitter, leaves.size(), nodes_[node].box,
                                      {rules_.cost, 1, std::min(levels, few)}, {});
  std::vector<std::uint32_t> place(tree.nodes.size());
  place[0] = node;
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const TreeNode& from = tree.nodes[i];
    place[i] = from.is_leaf() ? tree.references[from.first] : take_node();
  }
  nodes_[node].children = 0, nodes_[node].first_child = kNone, nodes_[node].leaves = 0;
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    if (tree.nodes[i].is_leaf()) continue;
    const std::uint32_t left = place[i + 1], right = place[tree.nodes[i].right];
    add_child(place[i], left);
    add_child(place[i], right);
    Node& n = nodes_[place[i]];
    n.box = tree.nodes[i].box, n.area = n.box.half_area();
    n.leaves = nodes_[left].leaves + nodes_[right].leaves;
    n.height = std::max(nodes_[left].height, nodes_[right].height) + 1;
  }
  // The ancestors are as high as what is highest in them now.
  for (std::uint32_t at = nodes_[node].parent; at != kNone; at = nodes_[at].parent) {
    int height = 0;
    for_children(at, [&](std::uint32_t c) { height = std::max(height, nodes_[c].height + 1); });
    nodes_[at].height = height;
  }
}

/// Per node, whether what is below it is as cheap in one leaf.
std::vector<std::uint8_t> Grower::choose_leaves() const {
  std::vector<std::uint32_t> order{root_};  // parents first
  for (std::size_t i = 0; i < order.size(); ++i)
    for_children(order[i], [&](std::uint32_t c) { order.push_back(c); });
  std::vector<double> cost(nodes_.size(), 0.0);
  std::vector<std::uint8_t> is_leaf(nodes_.size(), 0);
  for (std::size_t i = order.size(); i-- > 0;) {
    const std::uint32_t at = order[i];
    const Node& node = nodes_[at];
    const double share = sah_share(node.area, nodes_[root_].area);
    const double as_leaf = share * sah_leaf_cost(rules_.cost, node.leaves);
    double as_inner = share * rules_.cost.traverse;
    for_children(at, [&](std::uint32_t c) { as_inner += cost[c]; });
    is_leaf[at] = node.is_leaf() || (node.leaves <= rules_.max_leaf && as_leaf <= as_inner);
    cost[at] = is_leaf[at] ? as_leaf : as_inner;
  }
  return is_leaf;
}

/// References below a node, ascending, appended.
void Grower::list(std::uint32_t node, std::vector<std::uint32_t>& references) const {
  const auto first = static_cast<std::ptrdiff_t>(references.size());
  std::vector<std::uint32_t> waiting{node};
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.back();
    waiting.pop_back();
    if (nodes_[at].is_leaf()) references.push_back(refs_[nodes_[at].reference].reference);
    for_children(at, [&](std::uint32_t c) { waiting.push_back(c); });
  }
  std::sort(references.begin() + first, references.end());
}

Hierarchy Grower::finish() const {
  const std::vector<std::uint8_t> is_leaf = choose_leaves();
  Hierarchy out;
  out.nodes.push_back({nodes_[root_].box});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting{{root_, 0}};
  while (!waiting.empty()) {
    const auto [from, to] = waiting.back();
    waiting.pop_back();
    if (is_leaf[from]) {
      out.nodes[to].first = static_cast<std::uint32_t>(out.references.size());
      out.nodes[to].count = nodes_[from].leaves;
      list(from, out.references);
      continue;
    }
    auto child = static_cast<std::uint32_t>(out.nodes.size());
    out.nodes[to].first = child;
    out.nodes[to].children = nodes_[from].children;
    for_children(from, [&](std::uint32_t c) {
      out.nodes.push_back({nodes_[c].box});
      waiting.push_back({c, child++});
    });
    std::reverse(waiting.end() - static_cast<std::ptrdiff_t>(nodes_[from].children), waiting.end());
  }
  return out;
}

std::vector<std::uint32_t> order_of(std::span<const PrimRef> refs, const InsertionRules& rules) {
  std::vector<std::uint32_t> order(refs.size());
  std::iota(order.begin(), order.end(), 0u);
  if (rules.order == InsertOrder::sorted) {
    Aabb centers;
    for (const PrimRef& ref : refs) centers.extend(doubled_center(ref.box));
    const int axis = centers.longest_axis();
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return doubled_center(refs[a].box)[axis] < doubled_center(refs[b].box)[axis];
    });
  } else if (rules.order == InsertOrder::shuffled) {
    Rng rng(rules.seed);
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
  }
  return order;
}

}  // namespace

Hierarchy build_insertion_tree(std::span<const PrimRef> refs, const InsertionRules& rules,
                               const BuildContext& context) {
  constexpr std::size_t kReportEvery = 1024;
  context.require_memory(refs.size() * (2 * sizeof(Node) + sizeof(PrimRef) +
                                        2 * sizeof(HierarchyNode) + 4 * sizeof(std::uint32_t)),
                         "insertion tree");
  Grower grower(refs, rules);
  std::size_t done = 0;
  for (const std::uint32_t i : order_of(refs, rules)) {
    if (done % kReportEvery == 0)
      context.check(static_cast<double>(done) / static_cast<double>(refs.size()), "building");
    grower.insert(i);
    ++done;
  }
  return grower.finish();
}

double insertion_cost(const Hierarchy& hierarchy) {
  double sum = 1.0;
  for (const HierarchyNode& node : hierarchy.nodes) {
    if (node.count == 1) continue;  // tested by its parent
    sum += sah_share(node.box.half_area(), hierarchy.nodes[0].box.half_area()) *
           static_cast<double>(node.children + node.count);
  }
  return sum;
}

}  // namespace strahl
