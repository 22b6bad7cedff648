#include <stdexcept>
#include <string>

#include <strahl/structures/kd_tree/kd_links.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("kd_tree: ") + broken);
}

/// Cells of all nodes; children follow their parent.
std::vector<Aabb> cells_of(const KdNodes& nodes, const Aabb& root) {
  std::vector<Aabb> cells(nodes.size());
  cells[0] = root;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const KdNode& node = nodes[i];
    if (node.is_leaf()) continue;
    cells[i + 1] = cells[node.right()] = cells[i];
    cells[i + 1].hi[node.axis()] = cells[node.right()].lo[node.axis()] = node.plane();
  }
  return cells;
}

/// First nodes behind the subtrees of all nodes; parents come before their children.
std::vector<std::uint32_t> ends_of(const KdNodes& nodes) {
  std::vector<std::uint32_t> ends(nodes.size(), static_cast<std::uint32_t>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].is_leaf()) continue;
    ends[nodes[i].right()] = ends[i];
    ends[i + 1] = nodes[i].right();
  }
  return ends;
}

/// Whether `stored` is v, or where it is no float the next one outside.
bool is_rounded(float stored, double v, bool upward) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const double s = static_cast<double>(stored);
  const float inward = std::nextafter(stored, upward ? -kInf : kInf);
  return upward ? s >= v && (s == v || static_cast<double>(inward) < v)
                : s <= v && (s == v || static_cast<double>(inward) > v);
}

double face_of(const Aabb& cell, int axis, bool upper) {
  return upper ? cell.hi[axis] : cell.lo[axis];
}

/// Whether the box holds the whole face of the cell on one side of the plane of the face.
bool covers_face(const Aabb& box, const Aabb& cell, int axis, bool upper) {
  if (face_of(box, axis, !upper) != face_of(cell, axis, upper)) return false;
  for (int other = 0; other < 3; ++other)
    if (other != axis && !(box.lo[other] <= cell.lo[other] && cell.hi[other] <= box.hi[other]))
      return false;
  return true;
}

/// Checks the ropes of one leaf.
void check_cell(const RopedCell& roped, std::size_t leaf, const KdNodes& nodes,
                const std::vector<Aabb>& cells) {
  const Aabb &cell = cells[leaf], &root = cells[0];
  for (std::size_t face = 0; face < 6; ++face) {
    const int axis = static_cast<int>(face / 2);
    const bool upper = face % 2 == 1;
    demand(is_rounded(roped.face[face], face_of(cell, axis, upper), upper),
           "a face is not that of its cell");
    const std::uint32_t rope = roped.rope[face];
    const bool is_border = face_of(cell, axis, upper) == face_of(root, axis, upper);
    demand((rope == RopedCell::kNoRope) == is_border, "a rope is missing or leaves the scene");
    if (is_border) continue;
    demand(rope < nodes.size(), "a rope beyond the last node");
    demand(covers_face(cells[rope], cell, axis, upper), "a rope leads to what is not at its face");
    if (nodes[rope].is_leaf()) continue;
    demand(!covers_face(cells[rope + 1], cell, axis, upper) &&
               !covers_face(cells[nodes[rope].right()], cell, axis, upper),
           "a rope is not pushed down");
  }
}

}  // namespace

void check_gates(const KdLinks& links, const KdNodes& nodes, const Aabb& root) {
  const std::vector<Aabb> cells = cells_of(nodes, root);
  const std::vector<std::uint32_t> ends = ends_of(nodes);
  demand(links.gates.size() == nodes.size() / 2, "not one gate per inner node");
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    if (!nodes[i].is_leaf()) continue;
    const Gate& gate = links.gates[next++];
    demand(gate.end == ends[i + 1], "a gate does not end behind its subtree");
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      demand(is_rounded(gate.lo[a], cells[i + 1].lo[axis], false) &&
                 is_rounded(gate.hi[a], cells[i + 1].hi[axis], true),
             "a gate is not the cell of its subtree");
    }
  }
}

void check_ropes(const KdLinks& links, const KdNodes& nodes, const Aabb& root) {
  const std::vector<Aabb> cells = cells_of(nodes, root);
  demand(links.cells.size() == nodes.size() / 2 + 1, "not one roped cell per leaf");
  demand(links.place.size() == nodes.size(), "not one place per node");
  std::uint32_t leaves = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    demand(links.place[i] == leaves, "a place is not the number of leaves before it");
    if (nodes[i].is_leaf()) check_cell(links.cells[leaves++], i, nodes, cells);
  }
}

}  // namespace strahl
