// base/fp_env.cpp - saving, setting and restoring the floating-point environment.
//
// Out of line on purpose: the opaque calls keep the compiler from moving arithmetic across them.
#include <strahl/base/fp_env.h>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#define STRAHL_HAVE_MXCSR 1
#endif

namespace strahl {
namespace {

#ifdef STRAHL_HAVE_MXCSR
// All six exceptions masked, nearest, FTZ and DAZ off, no sticky flag: the reset value of MXCSR.
constexpr unsigned kCleanMxcsr = 0x1F80;
#endif

}  // namespace

FpEnvGuard::FpEnvGuard() noexcept {
  std::fegetenv(&saved_);
#ifdef STRAHL_HAVE_MXCSR
  saved_mxcsr_ = _mm_getcsr();
#endif
  std::fesetenv(FE_DFL_ENV);
#ifdef STRAHL_HAVE_MXCSR
  // What a C library does with FTZ and DAZ is its own choice, so set the register itself as well.
  _mm_setcsr(kCleanMxcsr);
#endif
}

FpEnvGuard::~FpEnvGuard() {
  std::fesetenv(&saved_);
#ifdef STRAHL_HAVE_MXCSR
  _mm_setcsr(saved_mxcsr_);
#endif
}

}  // namespace strahl
