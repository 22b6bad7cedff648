// tests/conformance/forced_isa.h - the instruction sets of wide_bvh's kernels, one after the other.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::test {

/// Forces an instruction set for structures built during its life.
class ForcedIsa {
 public:
  explicit ForcedIsa(const char* isa) { ::setenv("STRAHL_ISA", isa, 1); }
  ~ForcedIsa() { ::unsetenv("STRAHL_ISA"); }
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;
};

/// Those of this machine.
inline std::vector<std::string> isas() {
  std::vector<std::string> names;
  for (const WideKernel* kernel : wide_kernels()) names.emplace_back(kernel->isa);
  return names;
}

}  // namespace strahl::test
