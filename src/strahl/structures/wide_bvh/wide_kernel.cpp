// Compiled once per instruction set by Highway's foreach_target; the part at the end once.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include <strahl/base/error.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "strahl/structures/wide_bvh/wide_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <strahl/structures/wide_bvh/wide_packet-inl.h>
#include <strahl/structures/wide_bvh/wide_prepare-inl.h>
#include <strahl/structures/wide_bvh/wide_settle-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

// In wide_decide.cpp.
WideDecision decide8(const WideTree& tree, const WideRays& rays, std::uint32_t ray, WideId leaf,
                     std::uint32_t lanes);
WideDecision decide16(const WideTree& tree, const WideRays& rays, std::uint32_t ray, WideId leaf,
                      std::uint32_t lanes);

template <WideMode M>
void add_mode(WideKernel& kernel) {
  auto& row = kernel.traverse[static_cast<std::size_t>(M)];
  row[0][0] = &traverse<8, M, false>, row[1][0] = &traverse<8, M, true>;
  row[0][1] = &traverse<16, M, false>, row[1][1] = &traverse<16, M, true>;
}

template <WideMode M, int W>
void add_flight(WideKernel& kernel) {
  if constexpr (kSortsAtOnce<W>) kernel.fly[static_cast<std::size_t>(M)][W == 16] = &fly<W, M>;
}

WideKernel make_kernel(const char* isa) {
  WideKernel kernel;
  kernel.isa = isa, kernel.prepare = &prepare, kernel.settle = &settle;
  kernel.settle_given = &settle_given;
  kernel.decide[0] = &decide8, kernel.decide[1] = &decide16;
  kernel.best_width = HWY_MAX_BYTES >= 64 ? 16 : 8;
  add_mode<WideMode::closest>(kernel);
  add_mode<WideMode::any>(kernel);
  add_mode<WideMode::each>(kernel);
  add_flight<WideMode::closest, 8>(kernel), add_flight<WideMode::any, 8>(kernel);
  add_flight<WideMode::closest, 16>(kernel), add_flight<WideMode::any, 16>(kernel);
  return kernel;
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace strahl {
namespace {

/// Kernels this build has, best first.
std::vector<WideKernel> make_all() {
  const std::int64_t supported = hwy::SupportedTargets() | HWY_STATIC_TARGET;
  std::vector<WideKernel> kernels;
  // Even making a kernel runs code of its instruction set.
  [[maybe_unused]] const auto add = [&](std::int64_t target, WideKernel (*make)(const char*),
                                        const char* isa) {
    if ((supported & target) != 0) kernels.push_back(make(isa));
  };
#if HWY_TARGETS & HWY_AVX3
  add(HWY_AVX3, &N_AVX3::make_kernel, "avx512");
#endif
#if HWY_TARGETS & HWY_AVX2
  add(HWY_AVX2, &N_AVX2::make_kernel, "avx2");
#endif
#if HWY_TARGETS & HWY_SSE4
  add(HWY_SSE4, &N_SSE4::make_kernel, "sse4");
#endif
#if HWY_TARGETS & HWY_NEON
  add(HWY_NEON, &N_NEON::make_kernel, "neon");
#endif
#if HWY_TARGETS & HWY_EMU128
  kernels.push_back(N_EMU128::make_kernel("scalar"));
#elif HWY_TARGETS & HWY_SCALAR
  kernels.push_back(N_SCALAR::make_kernel("scalar"));
#endif
  return kernels;
}

std::string names() {
  std::string list;
  for (const WideKernel* kernel : wide_kernels())
    list += (list.empty() ? "" : ", ") + std::string(kernel->isa);
  return list;
}

}  // namespace

std::span<const WideKernel* const> wide_kernels() {
  static const std::vector<WideKernel> all = make_all();
  static const std::vector<const WideKernel*> pointers = [] {
    std::vector<const WideKernel*> list;
    for (const WideKernel& kernel : all) list.push_back(&kernel);
    return list;
  }();
  return pointers;
}

const WideKernel& wide_kernel(std::string_view isa) {
  if (isa.empty()) return *wide_kernels().front();
  for (const WideKernel* kernel : wide_kernels())
    if (kernel->isa == isa) return *kernel;
  throw Error(ErrorCode::usage, "got '" + std::string(isa) + "', this machine has " + names(),
              "STRAHL_ISA");
}

const WideKernel& wide_kernel_of_environment() {
  const char* isa = std::getenv("STRAHL_ISA");
  return wide_kernel(isa == nullptr ? "" : isa);
}

}  // namespace strahl
#endif  // HWY_ONCE
