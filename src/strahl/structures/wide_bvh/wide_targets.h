// structures/wide_bvh/wide_targets.h - the instruction sets that kernels are compiled for.
//
// To be included before Highway, by each file that is compiled once per instruction set.
#pragma once

// Sets of extensions that the kernels have no use for, and those whose registers have no size known
// to the compiler: they cannot be members.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
