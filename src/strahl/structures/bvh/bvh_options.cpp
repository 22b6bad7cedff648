#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {
namespace {

std::vector<std::pair<std::string, BvhVolume>> volume_words() {
  std::vector<std::pair<std::string, BvhVolume>> words;
  words.reserve(std::size(kBoundingVolumes) + 1);
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    words.emplace_back(info.name, static_cast<BvhVolume>(info.kind));
  words.emplace_back("auto", BvhVolume::automatic);
  return words;
}

}  // namespace

OptionTable<BvhOptions> option_fields(const BvhOptions*) {
  return {
      option("bv", &BvhOptions::bv, volume_words(),
             "bounding volume of the nodes; auto: of each the cheapest"),
      option(
          "builder", &BvhOptions::builder,
          {{"scene_graph", BvhBuilder::scene_graph},
           {"median_cyclic", BvhBuilder::median_cyclic},
           {"median_longest", BvhBuilder::median_longest},
           {"goldsmith_salmon", BvhBuilder::goldsmith_salmon},
           {"sah_sweep", BvhBuilder::sah_sweep},
           {"sah_binned", BvhBuilder::sah_binned},
           {"spatial", BvhBuilder::spatial},
           {"agglomerative", BvhBuilder::agglomerative},
           {"lbvh", BvhBuilder::lbvh},
           {"ploc", BvhBuilder::ploc}},
          "groups of the model; median cut, axes in turn or the longest; insertion; SAH, exact "
          "or by bins, or by bins with cut primitives; bottom-up by nearest pairs; Morton codes; "
          "neighbours on their curve"),
      option("optimise", &BvhOptions::optimise,
             {{"none", BvhOptimise::none},
              {"rotations", BvhOptimise::rotations},
              {"reinsertion", BvhOptimise::reinsertion}},
             "what is done to the tree afterwards"),
      option("bins", &BvhOptions::bins, 2, 256, "bins per axis of sah_binned and spatial"),
      option("duplicates", &BvhOptions::duplicates, 0.0, 8.0,
             "spatial: references there may be more than primitives, per primitive"),
      option("radius", &BvhOptions::radius, 1, 256, "neighbours on either side that ploc looks at"),
      option("insert_search", &BvhOptions::insert_search,
             {{"growth", InsertSearch::growth},
              {"local", InsertSearch::local},
              {"branch_and_bound", InsertSearch::branch_and_bound}},
             "goldsmith_salmon: down by least growth, down by least own cost, or everywhere"),
      option("insert_order", &BvhOptions::insert_order,
             {{"file", InsertOrder::file},
              {"sorted", InsertOrder::sorted},
              {"shuffled", InsertOrder::shuffled}},
             "goldsmith_salmon: order of insertion"),
      option("seed", &BvhOptions::seed, "of the shuffled order"),
      option("attach_share", &BvhOptions::attach_share, 0.0, 2.0,
             "goldsmith_salmon with arity > 2: attached where every child would reach this part of "
             "the area"),
      option("arity", &BvhOptions::arity, 2, 16, "most children of a node"),
      option("leaf_size", &BvhOptions::leaf_size, 1, 1024, "most primitives in a leaf"),
      option("traverse_cost", &BvhOptions::traverse_cost, 0.001, 1000.0, "cost of a node step"),
      option("intersect_cost", &BvhOptions::intersect_cost, 0.001, 1000.0,
             "cost of a primitive test"),
      option(
          "traversal", &BvhOptions::traversal,
          {{"dfs", BvhTraversal::dfs},
           {"ordered", BvhTraversal::ordered},
           {"direction", BvhTraversal::direction},
           {"heap", BvhTraversal::heap}},
          "order of visits: the tree's, nearest child first, children by the ray's direction, or "
          "nearest of all from a heap"),
      option("rebuild_factor", &BvhOptions::rebuild_factor, 1.0, 1000.0,
             "when things move: built anew where fitting makes the SAH cost this times as high"),
  };
}

}  // namespace strahl
