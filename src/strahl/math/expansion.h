// math/expansion.h - exact sums, differences and products of doubles, of bounded length.
//
// Paper:      [Shewchuk1997] sections 2.1-2.8 (two-sum, two-product, expansion sum, scaling).
// Layout:     term[0..count) in increasing magnitude, non-overlapping, zeros removed; the value is
//             the exact sum; capacity N is a compile-time bound, so nothing is allocated.
// Invariants: |term[i]| < ulp of term[i + 1]; count == 0 means zero. Needs round-to-nearest, no
//             overflow and no underflow: guaranteed by the coordinate range 2^-240..2^240.
// Differs:    products are sums of scaled copies; no attempt at adaptivity (the floating-point
//             filter in front decides almost always).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace strahl {

/// An exact value as a sum of at most N doubles.
template <std::size_t N>
struct Expansion {
  std::array<double, N> term;
  std::size_t count = 0;

  Expansion() = default;
  explicit Expansion(double v) { push(v); }

  void push(double v) {
    if (v != 0.0) term[count++] = v;
  }
  /// -1, 0 or 1: the sign of the largest term is the sign of the sum.
  int sign() const { return count == 0 ? 0 : term[count - 1] > 0.0 ? 1 : -1; }
};

/// a + b exactly as sum + error.
struct TwoTerms {
  double high, low;
};
inline TwoTerms two_sum(double a, double b) {
  const double s = a + b;
  const double bv = s - a;
  return {s, (a - (s - bv)) + (b - bv)};
}
/// v exactly as the sum of two halves of 26 bits each ([Dekker1971]).
inline TwoTerms split_halves(double v) {
  const double scaled = 0x1.0000002p27 * v;
  const double high = scaled - (scaled - v);
  return {high, v - high};
}
/// a * b exactly as product + error, by halves: a fused multiply-add would be a library call on
/// baseline machines. Requires |a * b| > 2^-969 or 0, and no overflow.
inline TwoTerms two_product(double a, double b) {
  const TwoTerms x = split_halves(a), y = split_halves(b);
  const double p = a * b;
  return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

/// a - b exactly.
inline Expansion<2> exact_difference(double a, double b) {
  const TwoTerms d = two_sum(a, -b);
  Expansion<2> e;
  e.push(d.low), e.push(d.high);
  return e;
}

template <std::size_t N>
Expansion<N> operator-(Expansion<N> a) {
  for (std::size_t i = 0; i < a.count; ++i) a.term[i] = -a.term[i];
  return a;
}

/// a + b: grows a by every term of b, smallest first.
template <std::size_t N, std::size_t M>
Expansion<N + M> operator+(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<N + M> sum;
  for (std::size_t i = 0; i < a.count; ++i) sum.term[i] = a.term[i];
  sum.count = a.count;
  for (std::size_t j = 0; j < b.count; ++j) {
    double carry = b.term[j];
    const std::size_t old = sum.count;
    sum.count = 0;
    for (std::size_t i = 0; i < old; ++i) {
      const TwoTerms t = two_sum(carry, sum.term[i]);
      carry = t.high;
      sum.push(t.low);
    }
    sum.push(carry);
  }
  return sum;
}

template <std::size_t N, std::size_t M>
Expansion<N + M> operator-(const Expansion<N>& a, const Expansion<M>& b) {
  return a + (-b);
}

/// a * b for one double b.
template <std::size_t N>
Expansion<2 * N> operator*(const Expansion<N>& a, double b) {
  Expansion<2 * N> product;
  if (a.count == 0 || b == 0.0) return product;
  TwoTerms p = two_product(a.term[0], b);
  product.push(p.low);
  double carry = p.high;
  for (std::size_t i = 1; i < a.count; ++i) {
    p = two_product(a.term[i], b);
    const TwoTerms low = two_sum(carry, p.low);
    product.push(low.low);
    const TwoTerms high = two_sum(p.high, low.high);
    product.push(high.low);
    carry = high.high;
  }
  product.push(carry);
  return product;
}

/// a * b as the sum of a scaled by every term of b.
template <std::size_t N, std::size_t M>
Expansion<2 * N * M> operator*(const Expansion<N>& a, const Expansion<M>& b) {
  Expansion<2 * N * M> product;
  for (std::size_t j = 0; j < b.count; ++j) {
    const Expansion<2 * N* M + 2 * N> next = product + a * b.term[j];
    // The exact product of j + 1 terms has at most 2 N (j + 1) of them, so it fits again.
    product.count = next.count;
    for (std::size_t i = 0; i < next.count; ++i) product.term[i] = next.term[i];
  }
  return product;
}

/// The double nearest to the exact value, ties to even.
template <std::size_t N>
double rounded(const Expansion<N>& e) {
  if (e.count == 0) return 0.0;
  // Sum from the top until a term no longer fits; what is below only decides an exact tie.
  std::size_t i = e.count - 1;
  double high = e.term[i], low = 0.0;
  while (i > 0 && low == 0.0) {
    const TwoTerms t = two_sum(high, e.term[--i]);
    high = t.high, low = t.low;
  }
  if (i > 0 && ((low < 0.0) == (e.term[i - 1] < 0.0))) {
    const double twice = 2.0 * low;
    const double next = high + twice;
    if (next - high == twice) high = next;
  }
  return high;
}

}  // namespace strahl
