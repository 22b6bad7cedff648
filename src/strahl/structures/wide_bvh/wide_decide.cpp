// Compiled once per instruction set by Highway's foreach_target. Apart from wide_kernel.cpp, so
// that how its loops are compiled does not depend on this.
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strahl/structures/wide_bvh/wide_decide.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <strahl/structures/wide_bvh/wide_decide-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

WideDecision decide8(const WideTree& tree, const WideRays& rays, std::uint32_t ray, WideId leaf,
                     std::uint32_t lanes) {
  return decide<8>(tree, rays, ray, leaf, lanes);
}
WideDecision decide16(const WideTree& tree, const WideRays& rays, std::uint32_t ray, WideId leaf,
                      std::uint32_t lanes) {
  return decide<16>(tree, rays, ray, leaf, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();
