// base/fp_env_test.cpp - the guard gives the clean environment and hands the old one back.
#include <cfenv>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/fp_env.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace strahl {
namespace {

// volatile operands and results keep the compiler from folding the arithmetic or moving it to where
// another environment holds.
double one_third() {
  volatile double one = 1.0;
  volatile double three = 3.0;
  volatile double quotient = one / three;
  return quotient;
}

double half_of_smallest_normal() {
  volatile double smallest = std::numeric_limits<double>::min();
  volatile double half = 0.5;
  volatile double product = smallest * half;
  return product;
}

TEST(FpEnvGuard, RoundsToNearestInsideAndRestoresTheDirectionOutside) {
  const double nearest = one_third();
  std::fesetround(FE_UPWARD);
  const double upward = one_third();
  double guarded = 0;
  {
    const FpEnvGuard guard;
    guarded = one_third();
  }
  const int direction = std::fegetround();
  const double after = one_third();
  std::fesetround(FE_TONEAREST);
  EXPECT_NE(upward, nearest);
  EXPECT_EQ(guarded, nearest);
  EXPECT_EQ(direction, FE_UPWARD);
  EXPECT_EQ(after, upward);
}

TEST(FpEnvGuard, HandsBackTheStickyFlagsOfTheCaller) {
  std::feclearexcept(FE_ALL_EXCEPT);
  std::feraiseexcept(FE_OVERFLOW);
  {
    const FpEnvGuard guard;
    EXPECT_EQ(std::fetestexcept(FE_OVERFLOW), 0);
    std::feraiseexcept(FE_INVALID);
  }
  EXPECT_NE(std::fetestexcept(FE_OVERFLOW), 0);
  EXPECT_EQ(std::fetestexcept(FE_INVALID), 0);
  std::feclearexcept(FE_ALL_EXCEPT);
}

#if defined(__SSE2__)
TEST(FpEnvGuard, KeepsSubnormalsInsideAndRestoresFlushToZeroOutside) {
  constexpr unsigned kFlushToZero = 0x8000;
  constexpr unsigned kDenormalsAreZero = 0x0040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | kFlushToZero | kDenormalsAreZero);
  const double flushed = half_of_smallest_normal();
  double guarded = 0;
  {
    const FpEnvGuard guard;
    guarded = half_of_smallest_normal();
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(before);
  EXPECT_EQ(flushed, 0.0);
  EXPECT_GT(guarded, 0.0);
  EXPECT_EQ(after & (kFlushToZero | kDenormalsAreZero), kFlushToZero | kDenormalsAreZero);
}

TEST(FpEnvGuard, MasksTrapsInside) {
  const unsigned before = _mm_getcsr();
  constexpr unsigned kDivideByZeroMask = 0x0200;
  _mm_setcsr(before & ~kDivideByZeroMask);
  volatile double infinite = 0;
  {
    const FpEnvGuard guard;
    volatile double zero = 0.0;
    infinite = 1.0 / zero;
  }
  _mm_setcsr(before);
  EXPECT_EQ(infinite, std::numeric_limits<double>::infinity());
}
#endif

}  // namespace
}  // namespace strahl
