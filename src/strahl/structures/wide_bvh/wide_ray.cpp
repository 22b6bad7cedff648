#include <algorithm>
#include <bit>
#include <cmath>

#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_ray.h>

namespace strahl {
namespace {

constexpr double kUnit = 0x1p-24;
constexpr double kLeastDir = 0x1p-60;
constexpr double kMostPlane = 0x1p100;  // beyond every plane's p * rcp, so its sign decides
constexpr double kMostT = 3e38;
constexpr double kFarOrigin = 16.0;  // in reaches: from here on a moved start is sharper

/// 2^j that brings the squared length into [0.25, 1.0001].
double unit_scale(double squared) {
  const auto bits = std::bit_cast<std::uint64_t>(squared * 0.9999);
  const int exponent = static_cast<int>(bits >> 52) - 1023;
  const int j = -((exponent + 2) >> 1);
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + j) << 52);
}

float above(double v) { return float_a_little_above(static_cast<float>(std::min(v, kMostT))); }
float below(double v) { return float_a_little_below(static_cast<float>(std::min(v, kMostT))); }

float plane_constant(double v) {
  return static_cast<float>(std::clamp(v, -kMostPlane, kMostPlane));
}

/// A parameter of o + t d before everything within `reach` of the frame's centre, o being far: the
/// ball of radius sqrt 3 reach is entered that long before its middle. Rounding errors of the
/// product are below 2^-46 |o|.
double moved_start(const Vec3d& o, const Vec3d& d, double reach) {
  const double squared = dot(d, d);
  const double before = 2 * reach + 0x1p-46 * norm1(o);
  const double start = -dot(o, d) / squared - before / std::sqrt(squared);
  return start > 0.0 ? start : 0.0;
}

}  // namespace

WideRay::WideRay(const Ray& ray, double widening, const WideFrame& frame)
    : signs(0), start(0.0), t_blur(0.0) {
  const double to_unit = unit_scale(dot(ray.dir, ray.dir));
  const Vec3d d = ray.dir * to_unit;
  per_t = frame.scale / to_unit;
  double blur = widening * frame.scale;
  Vec3d o = ray.org;
  if (!frame.is_identity()) {
    o = frame.to_frame(o);
    blur += 0x1p-52 * norm1(o);
  }
  const double distance = norm_max(o);
  if (distance > kFarOrigin * frame.reach) {
    start = moved_start(o, d, frame.reach + blur);
    blur += 0x1p-51 * (norm1(o) + start);
    o = o + start * d;
    if (start > 0.0) t_blur = 0x1p-39 * (start + 64 * frame.reach);
  }
  const double spread = kUnit * (3.01 * frame.reach + 2.02 * norm_max(o)) + 1.0001 * blur;
  double off = 0.0;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const bool is_negative = d[a] < 0.0;
    signs |= static_cast<std::uint32_t>(is_negative) << a;
    const double length = std::max(std::abs(d[a]), kLeastDir);
    const double r = 1.0 / (is_negative ? -length : length);
    const double c = -o[a] * r, pad = spread * std::abs(r);
    rcp[i] = static_cast<float>(r);
    near[i] = plane_constant(c - pad), far[i] = plane_constant(c + pad);
    dir[i] = static_cast<float>(d[a]);
    org[i] = static_cast<float>(std::clamp(o[a], -1e37, 1e37));
    off = std::max(off, std::abs(static_cast<double>(org[i]) - o[a]));
  }
  org_slack = off + blur > 0.0 ? above(kOriginWeight * (off + blur) * 1.7321) : 0.0f;
  const double first = ray.t_min * (1.0 - kHitMargin) * per_t - start - t_blur;
  const double sure = ray.t_min * (1.0 + kHitMargin) * per_t - start + t_blur;
  t_enter = first > 0.0 ? std::max(below(first), 0.0f) : 0.0f;
  t_enter_sure = sure > 0.0 ? above(sure) : 0.0f;
  t_blur2 = t_blur > 0.0 ? above(2 * t_blur) : 0.0f;
}

void WideRay::put(WideRays& rays, std::uint32_t i) const {
  for (std::size_t a = 0; a < 3; ++a) {
    rays.org[a][i] = org[a], rays.dir[a][i] = dir[a];
    rays.rcp[a][i] = rcp[a], rays.near[a][i] = near[a], rays.far[a][i] = far[a];
  }
  rays.org_slack[i] = org_slack, rays.t_blur2[i] = t_blur2, rays.signs[i] = signs;
  rays.t_enter[i] = t_enter, rays.t_enter_sure[i] = t_enter_sure;
}

float WideRay::upper(double t) const {
  const double v = t * (1.0 + kHitMargin) * per_t - start + t_blur;
  return v >= 0.0 ? above(v) : -1.0f;
}

float WideRay::lower(double t) const {
  const double v = t * (1.0 - kHitMargin) * per_t - start - t_blur;
  return v >= 0.0 ? below(v) : -1.0f;
}

}  // namespace strahl
