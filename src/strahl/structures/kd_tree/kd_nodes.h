// structures/kd_tree/kd_nodes.h - the nodes of a kd-tree, next to each other or farther apart.
//
// Layout: node i begins at byte i * node_bytes of 64-byte aligned memory. Padding is of no use but
//   to measure what small nodes bring; 8-byte nodes stay where the builder put them.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/kd_node.h>

namespace strahl {

enum class KdNodeBytes { b8 = 8, b16 = 16, b32 = 32, b64 = 64 };

/// Owns nodes at a distance chosen when made.
class KdNodes {
 public:
  KdNodes() = default;
  /// Takes the nodes. Throws Error{resource}.
  /// @param others bytes that the build owns besides
  KdNodes(std::vector<KdNode> nodes, KdNodeBytes distance, std::uint64_t others,
          const BuildContext& context);

  std::size_t size() const { return size_; }
  std::size_t bytes() const {
    return packed_.capacity() * sizeof(KdNode) + lines_.capacity() * sizeof(Line);
  }
  KdNodeBytes distance() const { return distance_; }
  const std::byte* data() const {
    return distance_ == KdNodeBytes::b8 ? reinterpret_cast<const std::byte*>(packed_.data())
                                        : lines_.data()->bytes;
  }
  const KdNode& operator[](std::size_t i) const {
    return *reinterpret_cast<const KdNode*>(data() + i * static_cast<std::size_t>(distance_));
  }
  /// A copy without padding.
  std::vector<KdNode> packed() const;

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<KdNode> packed_;
  std::vector<Line> lines_;
  std::size_t size_ = 0;
  KdNodeBytes distance_ = KdNodeBytes::b8;
};

}  // namespace strahl
