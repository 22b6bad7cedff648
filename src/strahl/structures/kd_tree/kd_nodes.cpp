#include <new>

#include <strahl/structures/kd_tree/kd_nodes.h>

namespace strahl {

KdNodes::KdNodes(std::vector<KdNode> nodes, KdNodeBytes distance, std::uint64_t others,
                 const BuildContext& context)
    : size_(nodes.size()), distance_(distance) {
  if (distance == KdNodeBytes::b8) {
    packed_ = std::move(nodes);
    return;
  }
  const auto step = static_cast<std::size_t>(distance);
  const std::size_t lines = (size_ * step + sizeof(Line) - 1) / sizeof(Line);
  context.require_memory(others + nodes.capacity() * sizeof(KdNode) + lines * sizeof(Line),
                         "kd_tree");
  lines_.resize(lines);
  std::byte* begin = lines_.data()->bytes;
  for (std::size_t i = 0; i < size_; ++i) new (begin + i * step) KdNode(nodes[i]);
}

std::vector<KdNode> KdNodes::packed() const {
  if (distance_ == KdNodeBytes::b8) return packed_;
  std::vector<KdNode> all;
  all.reserve(size_);
  for (std::size_t i = 0; i < size_; ++i) all.push_back((*this)[i]);
  return all;
}

}  // namespace strahl
