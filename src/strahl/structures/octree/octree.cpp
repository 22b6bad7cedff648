#include <strahl/structures/octree/octree.h>

namespace strahl {

OptionTable<OctreeOptions> option_fields(const OctreeOptions*) {
  return octant_fields<OctreeOptions>();
}

}  // namespace strahl
