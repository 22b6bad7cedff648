// structures/bvh/bvh_options.h - what a bounding volume hierarchy is made of.
#pragma once

#include <strahl/base/options.h>

namespace strahl {

enum class BvhVolume { aabb };
enum class BvhBuilder { sah_sweep, sah_binned };

/// Costs are relative to each other; see README.md for how the defaults were measured.
struct BvhOptions {
  BvhVolume bv = BvhVolume::aabb;
  BvhBuilder builder = BvhBuilder::sah_binned;
  int bins = 32;
  int leaf_size = 4;
  double traverse_cost = 1.0;
  double intersect_cost = 1.0;
};

OptionTable<BvhOptions> option_fields(const BvhOptions*);

}  // namespace strahl
