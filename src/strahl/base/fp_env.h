// base/fp_env.h - the floating-point environment every exact computation runs in.
//
// The certificates of the hit tests assume rounding to nearest, gradual underflow and no traps; a
// host program may have changed any of them, per thread.
// Compilers may move arithmetic past a guard in the same function: do it in a function called
// through a pointer or reference (as executor tasks are) or from another file. Thread safety: the
// environment belongs to the thread; a guard must die on the thread it was made.
#pragma once

#include <cfenv>

namespace strahl {

/// Sets rounding to nearest, subnormals kept (no flush-to-zero, no denormals-are-zero) and all
/// exceptions masked for the calling thread; its destructor restores the environment found,
/// sticky flags included.
class FpEnvGuard {
 public:
  FpEnvGuard() noexcept;
  ~FpEnvGuard();
  FpEnvGuard(const FpEnvGuard&) = delete;
  FpEnvGuard& operator=(const FpEnvGuard&) = delete;

 private:
  std::fenv_t saved_;
  unsigned saved_mxcsr_ = 0;
};

}  // namespace strahl
