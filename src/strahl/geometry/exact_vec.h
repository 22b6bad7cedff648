// geometry/exact_vec.h - vectors of expansions, for what no rounded number decides.
//
// Thread safety: values.
#pragma once

#include <strahl/math/expansion.h>
#include <strahl/math/vec3.h>

namespace strahl {

template <std::size_t N>
struct ExactVec {
  Expansion<N> x, y, z;
};

inline ExactVec<2> difference(const Vec3d& a, const Vec3d& b) {
  return {exact_difference(a.x, b.x), exact_difference(a.y, b.y), exact_difference(a.z, b.z)};
}
template <std::size_t N, std::size_t M>
auto exact_cross(const ExactVec<N>& a, const ExactVec<M>& b) {
  return ExactVec<4 * N * M>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <std::size_t N, std::size_t M>
auto exact_dot(const ExactVec<N>& a, const ExactVec<M>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline ExactVec<1> exact(const Vec3d& v) {
  return {Expansion<1>(v.x), Expansion<1>(v.y), Expansion<1>(v.z)};
}

}  // namespace strahl
