#include <strahl/bounds/intersection_volume.h>

namespace strahl {

template class Intersection<AabbVolume, ObbVolume>;

}  // namespace strahl
