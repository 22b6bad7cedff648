// structures/octree/octree.h - cells divided into eight, as deep as their contents ask for.
//
// Source: [Glassner1984]; Octree-R [Whang1995]; traversals [Revelles2000], [Samet1989].
// Layout and invariants: build/octants.h.
// Why no hit is lost: the point of a hit lies in the box of its primitive. With primitives in
//   leaves, closed leaf cells cover the scene, and each that holds the point refers to the
//   primitive; with `exact` because the clipped part that holds the point is bounded
//   conservatively. At inner nodes, every cell from the root to the one that refers to the
//   primitive encloses its box, enlarged or not. traverse/octants.h visits every closed cell that
//   holds a point of the ray, whatever planes it touches or lies in, and a node's own references
//   are tested when it is entered, before its children. A hit is kept whichever cell it was found
//   from, and a cell is skipped only when it begins beyond the best hit.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/build/octants.h>
#include <strahl/traverse/octants.h>

namespace strahl {

struct OctreeOptions : OctantOptions {};

OptionTable<OctreeOptions> option_fields(const OctreeOptions*);

/// O(log n) cells down to each of the leaves a ray meets. Memory: build/octants.h.
class Octree {
 public:
  using Options = OctreeOptions;
  static constexpr const char* kName = "octree";
  static constexpr const char* kTitle = "cells divided into eight where there is much in them";
  static constexpr bool kRefersOnce = false;

  Octree(const PrimitiveSource& source, const Options& options, const BuildContext& context)
      : tree_(source, options, OctantAxes{}, context, kName), traversal_(options.traversal) {}

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (!tree_.is_empty())
      trace_octants<3, kMaxOctantDepth>(tree_, traversal_ == OctantTraversal::neighbour, prims, ray,
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
