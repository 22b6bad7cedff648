#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {

OptionTable<BvhOptions> option_fields(const BvhOptions*) {
  return {
      option("bv", &BvhOptions::bv, {{"aabb", BvhVolume::aabb}}, "bounding volume of the nodes"),
      option("builder", &BvhOptions::builder,
             {{"sah_sweep", BvhBuilder::sah_sweep}, {"sah_binned", BvhBuilder::sah_binned}},
             "how primitives are divided: exact sweep, or bins over the centres"),
      option("bins", &BvhOptions::bins, 2, 256, "bins per axis of sah_binned"),
      option("leaf_size", &BvhOptions::leaf_size, 1, 1024, "most primitives in a leaf"),
      option("traverse_cost", &BvhOptions::traverse_cost, 0.001, 1000.0, "cost of a node step"),
      option("intersect_cost", &BvhOptions::intersect_cost, 0.001, 1000.0,
             "cost of a primitive test"),
  };
}

}  // namespace strahl
