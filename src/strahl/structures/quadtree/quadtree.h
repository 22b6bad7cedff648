// structures/quadtree/quadtree.h - columns divided into four: an octree with one axis undivided.
//
// Source: [Glassner1984] with one axis left out, as in the regions of [Samet1989].
// Layout and invariants: build/octants.h.
// Why no hit is lost: as in structures/octree/octree.h; on the undivided axis every cell reaches
//   from end to end of the scene.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/build/octants.h>
#include <strahl/traverse/octants.h>

namespace strahl {

enum class QuadtreeAxis { shortest, x, y, z };

struct QuadtreeOptions : OctantOptions {
  QuadtreeAxis undivided = QuadtreeAxis::shortest;
};

OptionTable<QuadtreeOptions> option_fields(const QuadtreeOptions*);

/// O(log n) cells down to each of the leaves a ray meets. Memory: build/octants.h.
class Quadtree {
 public:
  using Options = QuadtreeOptions;
  static constexpr const char* kName = "quadtree";
  static constexpr const char* kTitle = "columns divided into four where there is much in them";
  static constexpr bool kRefersOnce = false;

  Quadtree(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (!tree_.is_empty())
      trace_octants<2, kMaxOctantDepth>(tree_, traversal_ == OctantTraversal::neighbour, prims, ray,
                                        query, counters);
  }

  const BuildReport& report() const { return tree_.report(); }
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const { tree_.validate(source); }
  void hash_into(Hash64& hash) const { tree_.hash_into(hash); }

 private:
  OctantTree tree_;
  OctantTraversal traversal_;
};

}  // namespace strahl
