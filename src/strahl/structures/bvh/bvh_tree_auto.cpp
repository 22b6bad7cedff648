#include <strahl/structures/bvh/any_volume.h>
#include <strahl/structures/bvh/bvh_tree_impl.h>

namespace strahl {

template class BvhTree<AnyVolume>;

}  // namespace strahl
