#include <string>
#include <utility>
#include <vector>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {
namespace {

std::vector<std::pair<std::string, BvhVolume>> volume_words() {
  std::vector<std::pair<std::string, BvhVolume>> words;
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
      option("builder", &BvhOptions::builder,
             {{"sah_sweep", BvhBuilder::sah_sweep}, {"sah_binned", BvhBuilder::sah_binned}},
             "how primitives are divided: exact sweep, or bins over the centres"),
      option("bins", &BvhOptions::bins, 2, 256, "bins per axis of sah_binned"),
      option("leaf_size", &BvhOptions::leaf_size, 1, 1024, "most primitives in a leaf"),
      option("traverse_cost", &BvhOptions::traverse_cost, 0.001, 1000.0, "cost of a node step"),
      option("intersect_cost", &BvhOptions::intersect_cost, 0.001, 1000.0,
             "cost of a primitive test"),
      option("traversal", &BvhOptions::traversal,
             {{"dfs", BvhTraversal::dfs},
              {"ordered", BvhTraversal::ordered},
              {"heap", BvhTraversal::heap}},
             "order of visits: the tree's, nearest child first, or nearest of all from a heap"),
  };
}

}  // namespace strahl
