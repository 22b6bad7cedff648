// math/vec3.h - three-component vectors; plain values, no alignment games.
#pragma once

#include <cmath>
#include <cstddef>

namespace strahl {

/// Three components of type T. Arithmetic is component-wise and never contracted to FMA.
template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  /// Exact where U's values are values of T (float to double).
  template <class U>
  explicit constexpr Vec3(const Vec3<U>& v)
      : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
  static constexpr Vec3 all(T v) { return {v, v, v}; }

  constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const Vec3&) const = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vec3<T> operator*(const Vec3<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
constexpr Vec3<T> operator*(T s, const Vec3<T>& a) {
  return a * s;
}
template <class T>
constexpr Vec3<T> operator/(const Vec3<T>& a, T s) {
  return {a.x / s, a.y / s, a.z / s};
}
/// ((x*x + y*y) + z*z): the order is part of the meaning wherever results are canonical.
template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T>
constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
template <class T>
Vec3<T> abs(const Vec3<T>& a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
template <class T>
T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalized(const Vec3<T>& a) {
  return a / length(a);
}
/// v scaled to length 1 without overflow or underflow; NaNs for the zero vector.
inline Vec3<double> unit(const Vec3<double>& v);
/// Sum of the magnitudes.
template <class T>
T norm1(const Vec3<T>& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
/// Largest magnitude.
template <class T>
T norm_max(const Vec3<T>& a) {
  const T xy = std::abs(a.x) > std::abs(a.y) ? std::abs(a.x) : std::abs(a.y);
  return xy > std::abs(a.z) ? xy : std::abs(a.z);
}
inline Vec3<double> unit(const Vec3<double>& v) { return normalized(v / norm_max(v)); }
template <class T>
bool is_finite(const Vec3<T>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

}  // namespace strahl
