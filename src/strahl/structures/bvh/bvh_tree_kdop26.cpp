#include <strahl/structures/bvh/bvh_tree_impl.h>

namespace strahl {

template class BvhTree<KdopVolume<26>>;

}  // namespace strahl
