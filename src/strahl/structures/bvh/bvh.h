// structures/bvh/bvh.h - bounding volume hierarchy: primitives divided among volumes of any kind.
//
// Papers:     [RubinWhitted1980]; kinds of volumes [Weghorst1984], [KayKajiya1986]; builders see
//             bvh_build.h, volumes bounds/, nodes bvh_tree.h.
// Layout:     a tree over one type of volume, chosen when it is built. Pairs of boxes visited
// nearest
//             first are traced by code of each query's own, all else through one virtual call per
//             ray and one per leaf.
// Parts:      a builder may cut primitives, each part in a leaf of its own (refers_once()).
// Motion:     refit() keeps the tree and wraps its volumes anew, takes out what can no longer be
//             hit, inserts what now can, and builds anew when the SAH cost has grown by too much or
//             a quarter of the things has changed.
// Differs from the papers: volumes are tested in double with proven margins; hits are exact.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>

#include <strahl/bounds/aabb_volume.h>
#include <strahl/build/box_tree.h>
#include <strahl/geometry/scene.h>
#include <strahl/query/policies.h>
#include <strahl/structures/bvh/bvh_tree.h>

namespace strahl {

static_assert(sizeof(BvhNode<AabbVolume>) == 32);

/// O(log n) expected per ray. 32 bytes per node over boxes, 4 per reference.
class Bvh {
 public:
  using Options = BvhOptions;
  static constexpr const char* kName = "bvh";
  static constexpr const char* kTitle = "bounding volume hierarchy";

  Bvh(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  /// Follows things that have moved, come or gone (a thing is there if its box is not empty, see
  /// geometry/subset_source.h), numbered as those it was built over. Deterministic for any
  /// executor, but depends on what was before. O(n + changes * log n) where it does not build. Not
  /// while rays are traced. Throws as a build does, and nothing has changed then.
  void refit(const PrimitiveSource& source, const BuildContext& context);
  /// The same, as Accelerator::update() calls it.
  void move(const Scene& scene, const BuildContext& context) { refit(scene, context); }
  /// How often it was fitted since it was last built.
  std::uint64_t refits() const { return refits_; }
  /// Whether no primitive is in two leaves.
  bool refers_once() const { return refers_once_; }

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (binary_boxes_ != nullptr)
      return walk(BvhView<AabbVolume, BvhOrder::entry, 2>(*binary_boxes_, ray), prims, ray, query,
                  counters);
    if (tree_ == nullptr) return;
    LeafQueryOf<Prims, Q, C> leaves(prims, ray, query, counters);
    tree_->trace(traversal_for<Q>(), ray, leaves, counters);
  }

  BuildReport report() const { return tree_ ? tree_->report() : BuildReport{}; }
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const {
    if (tree_) tree_->hash_into(hash);
  }
  VolumeEntry first_volume(const PreparedRay& ray, int depth) const {
    return tree_ ? tree_->first_volume(ray, depth) : VolumeEntry{};
  }
  /// Nothing where the volumes are not boxes. O(nodes).
  std::optional<BoxTree> box_tree() const;
  /// Whatever the volumes are. O(nodes).
  std::shared_ptr<const SideTree> side_tree() const;
  const VolumeTree* tree() const { return tree_.get(); }

 private:
  /// Only the search for the closest hit gains by a heap: no other query narrows its interval, so
  /// all that is in it gets visited, or any hit ends it.
  template <class Q>
  BvhTraversal traversal_for() const {
    const bool narrows = std::is_same_v<Q, ClosestHit>;
    return traversal_ == BvhTraversal::heap && !narrows ? BvhTraversal::dfs : traversal_;
  }

  explicit Bvh(const Options& options) : options_(options), traversal_(options.traversal) {}
  VisitCost visit_cost() const;
  void take(const PrimitiveSource& source, Hierarchy hierarchy, const BuildContext& context);

  friend class BvhBreaker;  ///< plants faults for the tests
  Options options_;
  std::unique_ptr<VolumeTree> tree_;                   ///< null when there is nothing to hit
  const BvhTree<AabbVolume>* binary_boxes_ = nullptr;  ///< the tree, if it has the fast path
  BvhTraversal traversal_;
  bool refers_once_ = true;
  double built_cost_ = 0.0;  ///< SAH, when it was last built
  std::uint64_t refits_ = 0;
};

}  // namespace strahl
