#include <cmath>
#include <optional>
#include <utility>

#include <strahl/io/gltf_nodes.h>

namespace strahl::gltf {
namespace {

constexpr std::uint32_t kNoParent = RigNode::kNoParent;

struct Links {
  std::vector<std::vector<std::uint32_t>> children;
  std::vector<std::uint32_t> parents;
};

Links read_links(const Document& document) {
  const std::size_t count = document.count("nodes");
  Links links{std::vector<std::vector<std::uint32_t>>(count),
              std::vector<std::uint32_t>(count, kNoParent)};
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::optional<JsonValue> list = document.item("nodes", n).find("children");
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      const std::uint32_t child = (*list)[i].index(count, "nodes");
      if (links.parents[child] != kNoParent)
        (*list)[i].fail("node " + std::to_string(child) + " is already a child of node " +
                        std::to_string(links.parents[child]));
      links.parents[child] = n;
      links.children[n].push_back(child);
    }
  }
  return links;
}

// Depth-first, parents before children, siblings in file order. `roots` must lead to no cycle.
std::vector<std::uint32_t> preorder(const Links& links, const std::vector<std::uint32_t>& roots) {
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> pending(roots.rbegin(), roots.rend());
  while (!pending.empty()) {
    const std::uint32_t n = pending.back();
    pending.pop_back();
    order.push_back(n);
    const std::vector<std::uint32_t>& children = links.children[n];
    pending.insert(pending.end(), children.rbegin(), children.rend());
  }
  return order;
}

// Every node that hangs below a root; those that do not are in a cycle.
std::vector<std::uint32_t> order_of_all(const Document& document, const Links& links) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t n = 0; n < links.parents.size(); ++n)
    if (links.parents[n] == kNoParent) roots.push_back(n);
  std::vector<std::uint32_t> order = preorder(links, roots);
  if (order.size() == links.parents.size()) return order;
  std::vector<bool> reached(links.parents.size());
  for (const std::uint32_t n : order) reached[n] = true;
  std::uint32_t lost = 0;
  while (reached[lost]) ++lost;
  document.item("nodes", lost).fail("the node is below itself: the hierarchy has a cycle");
}

template <std::size_t N>
std::array<double, N> numbers_or(const JsonValue& node, const char* key,
                                 const std::array<double, N>& otherwise) {
  const std::optional<JsonValue> member = node.find(key);
  return member ? member->numbers<N>() : otherwise;
}

NodePlace read_place(const JsonValue& node) {
  NodePlace place;
  if (const std::optional<JsonValue> matrix = node.find("matrix")) {
    place.matrix = from_columns(matrix->numbers<16>(), *matrix);
    return place;
  }
  const std::array<double, 3> t = numbers_or<3>(node, "translation", {0, 0, 0});
  const std::array<double, 3> s = numbers_or<3>(node, "scale", {1, 1, 1});
  place.translation = {t[0], t[1], t[2]};
  place.rotation = numbers_or<4>(node, "rotation", {0, 0, 0, 1});
  place.scale = {s[0], s[1], s[2]};
  return place;
}

std::vector<std::uint32_t> scene_roots(Document& document, const Links& links) {
  const std::optional<JsonValue> choice = document.root().find("scene");
  if (choice) choice->integer();
  if (document.count("scenes") == 0) {
    document.warn(document.root(), "the file has no scene, so there is nothing to show");
    return {};
  }
  const JsonValue scene =
      choice ? document.item("scenes", *choice) : document.item("scenes", std::size_t{0});
  string_or(scene, "name", "");
  const std::optional<JsonValue> list = scene.find("nodes");
  std::vector<std::uint32_t> roots;
  std::vector<bool> listed(links.parents.size());
  for (std::size_t i = 0; list && i < list->size(); ++i) {
    const std::uint32_t n = (*list)[i].index(links.parents.size(), "nodes");
    if (links.parents[n] != kNoParent || listed[n])
      (*list)[i].fail("node " + std::to_string(n) + " would appear twice in the hierarchy");
    listed[n] = true;
    roots.push_back(n);
  }
  return roots;
}

}  // namespace

NodeTree read_nodes(Document& document) {
  const Links links = read_links(document);
  NodeTree tree;
  tree.rig.nodes.resize(links.parents.size());
  tree.rig.order = order_of_all(document, links);
  std::vector<NodePlace> rest(links.parents.size());
  for (const std::uint32_t n : tree.rig.order) {
    const JsonValue node = document.item("nodes", n);
    rest[n] = read_place(node);
    tree.rig.nodes[n] = {string_or(node, "name", ""), links.parents[n], rest[n]};
  }
  tree.to_world = tree.rig.to_world(rest);
  tree.order = preorder(links, scene_roots(document, links));
  return tree;
}

Affine from_columns(const std::array<double, 16>& columns, const JsonValue& place) {
  // Exporters' float arithmetic leaves a little noise in the last row.
  constexpr double kNoise = 1e-5;
  for (std::size_t c = 0; c < 4; ++c)
    if (!(std::abs(columns[4 * c + 3] - (c == 3 ? 1.0 : 0.0)) <= kNoise))
      place.fail("the last row of the matrix is not 0 0 0 1");
  Affine result;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) result.m[r][c] = columns[4 * c + r];
  return result;
}

}  // namespace strahl::gltf
