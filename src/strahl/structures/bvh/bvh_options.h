// structures/bvh/bvh_options.h - what a bounding volume hierarchy is made of.
#pragma once

#include <cstdint>

#include <strahl/base/options.h>
#include <strahl/build/insertion_tree.h>

namespace strahl {

/// One kind for all nodes, in the order of BoundingVolumeKind; or per node by its cost.
enum class BvhVolume {
  aabb,
  sphere,
  obb,
  kdop6,
  kdop14,
  kdop18,
  kdop26,
  cylinder,
  hull,
  prism,
  shell,
  intersection,
  automatic
};
/// In the order of the tree; nearest child first; children by the ray's direction along the axis in
/// which their centres differ most; nearest of all waiting subtrees first.
enum class BvhTraversal { dfs, ordered, direction, heap };
enum class BvhBuilder {
  scene_graph,
  median_cyclic,
  median_longest,
  goldsmith_salmon,
  sah_sweep,
  sah_binned,
  spatial,
  agglomerative,
  lbvh,
  ploc
};
enum class BvhOptimise { none, rotations, reinsertion };

/// Costs are relative to each other; see README.md for how the defaults were measured.
struct BvhOptions {
  BvhVolume bv = BvhVolume::aabb;
  BvhBuilder builder = BvhBuilder::sah_binned;
  BvhOptimise optimise = BvhOptimise::none;
  int bins = 32;
  double duplicates = 0.3;
  int radius = 16;
  InsertSearch insert_search = InsertSearch::local;
  InsertOrder insert_order = InsertOrder::file;
  std::uint64_t seed = 0;
  double attach_share = 0.9;
  int arity = 2;
  int leaf_size = 4;
  double traverse_cost = 1.0;
  double intersect_cost = 1.0;
  BvhTraversal traversal = BvhTraversal::ordered;
  double rebuild_factor = 1.5;
};

OptionTable<BvhOptions> option_fields(const BvhOptions*);

}  // namespace strahl
