#include <strahl/structures/bvh/bvh_tree_impl.h>

namespace strahl {

template class BvhTree<PrismVolume>;

}  // namespace strahl
