#include <cfenv>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/math/expansion.h>

namespace strahl {
namespace {

using Rational = boost::multiprecision::cpp_rational;

template <std::size_t N>
Rational value(const Expansion<N>& e) {
  Rational sum = 0;
  for (std::size_t i = 0; i < e.count; ++i) sum += Rational(e.term[i]);
  return sum;
}

double random_double(Rng& rng) {
  return std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(120)) - 60);
}

/// Nearest double by comparing with both neighbours; ties to even.
double nearest(const Rational& exact) {
  double best = static_cast<double>(exact);
  for (const double other : {std::nextafter(best, -1e300), std::nextafter(best, 1e300)}) {
    const Rational a = abs(Rational(best) - exact), b = abs(Rational(other) - exact);
    int exponent = 0;
    const bool is_even = std::fmod(std::ldexp(std::frexp(other, &exponent), 53), 2.0) == 0.0;
    if (b < a || (b == a && is_even)) best = other;
  }
  return best;
}

TEST(Expansion, SumsAndProductsAreExact) {
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const double a = random_double(rng), b = random_double(rng), c = random_double(rng);
    const auto ab = exact_difference(a, b);
    ASSERT_EQ(value(ab), Rational(a) - Rational(b));
    const auto product = ab * exact_difference(b, c);
    ASSERT_EQ(value(product), (Rational(a) - Rational(b)) * (Rational(b) - Rational(c)));
    ASSERT_EQ(value(product * a + ab), value(product) * Rational(a) + value(ab));
  }
}

TEST(Expansion, TheLargestTermDecidesTheSign) {
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    const double a = random_double(rng);
    const double b = rng.below(2) ? a : std::nextafter(a, 1e300);
    const auto e = exact_difference(a, b) * exact_difference(random_double(rng), a);
    const Rational v = value(e);
    ASSERT_EQ(e.sign(), v > 0 ? 1 : v < 0 ? -1 : 0);
  }
}

TEST(Expansion, RoundsToTheNearestDoubleAndTiesToEven) {
  Rng rng(3);
  for (int i = 0; i < 20000; ++i) {
    const auto e = exact_difference(random_double(rng), random_double(rng)) * random_double(rng) -
                   exact_difference(random_double(rng), random_double(rng));
    ASSERT_EQ(rounded(e), nearest(value(e)));
  }
  // Exact ties, and ties broken by a term far below.
  for (const double low : {0x1p-53, -0x1p-53, 0x1p-54})
    for (const double far : {0.0, 0x1p-120, -0x1p-120}) {
      const auto e = Expansion<1>(1.0 + 0x1p-52) + Expansion<1>(low) + Expansion<1>(far);
      ASSERT_EQ(rounded(e), nearest(value(e))) << low << ' ' << far;
    }
}

}  // namespace
}  // namespace strahl
