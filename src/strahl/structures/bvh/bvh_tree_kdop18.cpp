#include <strahl/structures/bvh/bvh_tree_impl.h>

namespace strahl {

template class BvhTree<KdopVolume<18>>;

}  // namespace strahl
