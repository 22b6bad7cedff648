// tests/numeric/rational.h - the hit rule in rational arithmetic: an oracle that shares no code
// with the library.
#pragma once

#include <array>
#include <optional>

#include <boost/multiprecision/cpp_int.hpp>

#include <strahl/geometry/mesh.h>

namespace strahl::test {

using Rational = boost::multiprecision::cpp_rational;
using RationalVec = std::array<Rational, 3>;

inline RationalVec rational(const Vec3d& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
inline RationalVec minus(const RationalVec& a, const RationalVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline RationalVec cross_of(const RationalVec& a, const RationalVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Rational dot_of(const RationalVec& a, const RationalVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Sign of the directed edge (p, q) as the perturbed ray passes it; 0 when p == q.
inline int rational_edge_sign(const Vec3d& org, const Vec3d& dir, const Vec3d& p, const Vec3d& q) {
  const RationalVec o = rational(org), d = rational(dir), a = rational(p), b = rational(q);
  const RationalVec n = cross_of(minus(a, o), minus(b, o)), c = minus(b, a), m = cross_of(d, c);
  for (const Rational& term :
       {dot_of(d, n), n[0], n[1], n[2], m[0], m[1], m[2], Rational(-c[2]), c[1], Rational(-c[0])})
    if (term != 0) return term > 0 ? 1 : -1;
  return 0;
}

/// The common sign of the three edges, 0 when they do not agree.
inline int rational_crossing(const Vec3d& org, const Vec3d& dir, const TriangleVertices& t) {
  const int ab = rational_edge_sign(org, dir, t.a, t.b);
  const bool agree =
      ab == rational_edge_sign(org, dir, t.b, t.c) && ab == rational_edge_sign(org, dir, t.c, t.a);
  return agree ? ab : 0;
}

/// Numerator A . N, denominator dir . N and the two of u and v, exactly.
struct RationalHit {
  Rational numerator, denominator, u, v;
};
inline RationalHit rational_hit(const Vec3d& org, const Vec3d& dir, const TriangleVertices& t) {
  const RationalVec o = rational(org), d = rational(dir);
  const RationalVec a = rational(t.a), b = rational(t.b), c = rational(t.c);
  const RationalVec n = cross_of(minus(b, a), minus(c, a));
  const RationalVec ca = cross_of(minus(c, o), minus(a, o)),
                    ab = cross_of(minus(a, o), minus(b, o));
  RationalHit hit{dot_of(minus(a, o), n), dot_of(d, n), 0, 0};
  if (hit.denominator != 0) {
    hit.u = dot_of(d, ca) / hit.denominator, hit.v = dot_of(d, ab) / hit.denominator;
  } else {
    hit.u = dot_of(ca, n) / dot_of(n, n), hit.v = dot_of(ab, n) / dot_of(n, n);
  }
  return hit;
}

}  // namespace strahl::test
