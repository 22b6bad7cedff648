// bounds/volume_cases_test.h - sets that are hard to enclose and rays that are hard to keep, shared
// by the tests of all kinds of bounding volumes.
//
// Rays are exact by construction: targets and directions lie on coarse binary grids, so that
// org = target - t dir has no rounding and the ray passes the target at exactly t.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>

namespace strahl::test {

struct PointSet {
  std::string name;
  std::vector<Vec3d> points;  ///< every three make a triangle

  EnclosedSet enclosed() const {
    EnclosedSet set;
    std::size_t i = 0;
    for (; i + 2 < points.size(); i += 3)
      set.add(TriangleVertices{points[i], points[i + 1], points[i + 2]});
    for (; i < points.size(); ++i) set.add(points[i]);
    return set;
  }
};

/// A multiple of 2^-bits in [-1, 1].
inline double on_grid(Rng& rng, int bits) {
  const auto steps = static_cast<std::uint32_t>(1) << (bits + 1);
  return std::ldexp(static_cast<double>(rng.below(steps + 1)), -bits) - 1.0;
}
inline Vec3d grid_point(Rng& rng, int bits = 10) {
  const double x = on_grid(rng, bits), y = on_grid(rng, bits);
  return {x, y, on_grid(rng, bits)};
}

inline PointSet made(std::string name, std::size_t count, auto&& point) {
  PointSet set{std::move(name), {}};
  for (std::size_t i = 0; i < count; ++i) set.points.push_back(point(i));
  return set;
}

/// On grids of 2^-10, so that rays can be exact.
inline std::vector<PointSet> grid_sets() {
  Rng rng(7);
  std::vector<PointSet> sets;
  sets.push_back(made("one point", 1, [&](std::size_t) { return grid_point(rng); }));
  sets.push_back(made("coincident", 9, [&](std::size_t) { return Vec3d{0.5, -0.25, 0.125}; }));
  sets.push_back(made("two points", 2, [&](std::size_t) { return grid_point(rng); }));
  sets.push_back(made("collinear", 12, [&](std::size_t i) {
    return (static_cast<double>(i) / 16 - 0.25) * Vec3d{1, -0.5, 0.25};
  }));
  sets.push_back(made("coplanar", 30, [&](std::size_t) {
    const Vec3d p = grid_point(rng, 8);
    return Vec3d{p.x, p.y, 0.5 * p.x - 0.25 * p.y};
  }));
  sets.push_back(made("axis plane", 30, [&](std::size_t) {
    const Vec3d p = grid_point(rng);
    return Vec3d{p.x, 0.375, p.z};
  }));
  sets.push_back(made("triangle", 3, [&](std::size_t) { return grid_point(rng); }));
  sets.push_back({"sliver", {{0, 0, 0}, {1, 0.5, 0.25}, {0.5, 0.25, 0.125 + 0x1p-10}}});
  sets.push_back({"needle", {{-1, -1, -1}, {1, 1, 1}, {1, 1, 1 - 0x1p-10}}});
  sets.push_back(made("cube", 8, [&](std::size_t i) {
    return Vec3d{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
  }));
  sets.push_back(made("soup", 60, [&](std::size_t) { return grid_point(rng); }));
  sets.push_back(made("slanted rod", 90, [&](std::size_t) {
    const Vec3d p = grid_point(rng, 4);
    return on_grid(rng, 6) * Vec3d{1, 1, 0.5} + 0.0625 * p;
  }));
  sets.push_back(made("bowl", 150, [&](std::size_t) {
    const Vec3d p = grid_point(rng, 4);
    return Vec3d{p.x, p.y, 0.25 * (p.x * p.x + p.y * p.y)};
  }));
  sets.push_back(made("duplicates", 60, [&](std::size_t) {
    return Vec3d{on_grid(rng, 0), on_grid(rng, 0), on_grid(rng, 0)};
  }));
  return sets;
}

/// Anywhere in double: far away, huge, tiny, irrational.
inline std::vector<PointSet> wild_sets() {
  Rng rng(11);
  const auto point = [&] {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
    return Vec3d{x, y, rng.uniform(-1, 1)};
  };
  std::vector<PointSet> sets;
  for (const int size : {-200, -100, -30, 0, 30, 100, 200})
    sets.push_back(made("size 2^" + std::to_string(size), 40,
                        [&](std::size_t) { return std::ldexp(1.0, size) * point(); }));
  for (const double away : {1e3, 1e6, 1e12})
    sets.push_back(made("away by " + std::to_string(away), 40, [&](std::size_t) {
      return point() + Vec3d{away, -away, 0.5 * away};
    }));
  sets.push_back(made("flat up to rounding", 40, [&](std::size_t) {
    const Vec3d p = point();
    return Vec3d{p.x, p.y, p.x / 3.0 + p.y / 7.0};
  }));
  sets.push_back(made("straight up to rounding", 40, [&](std::size_t) {
    return rng.uniform() * Vec3d{1.0 / 3, 1.0 / 7, 1.0 / 11};
  }));
  sets.push_back(made("on a sphere", 200, [&](std::size_t) { return unit(point()); }));
  sets.push_back(
      made("outlier", 40, [&](std::size_t i) { return i == 7 ? 1e9 * point() : point(); }));
  return sets;
}

/// A point of the convex hull.
inline Vec3d mixture(const std::vector<Vec3d>& points, Rng& rng) {
  const auto any = [&] { return points[rng.below(static_cast<std::uint32_t>(points.size()))]; };
  const Vec3d a = any(), b = any(), c = any(), d = any();
  const double s = rng.uniform(), t = rng.uniform(), u = rng.uniform();
  return (1 - u) * ((1 - t) * ((1 - s) * a + s * b) + t * c) + u * d;
}

/// A prepared ray of a scene without instances.
inline PreparedRay prepared(const Vec3d& org, const Vec3d& dir, const Aabb& world) {
  RayFrame frame;
  frame.bounds = world;
  return PreparedRay({org, dir}, frame);
}

/// Where the volume lets the ray pass.
template <class V>
Interval passage(const V& volume, const PreparedRay& ray, const Aabb& world) {
  const typename V::RayData data(ray, world);
  return volume.clip(data, {ray.t_enter, ray.t_exit});
}

/// Whether a hit at t survives the test as a traversal makes it.
inline bool keeps(const Interval& span, double t) {
  return !(span.t_enter > span.t_exit) && !(lowered(span.t_enter, kHitMargin) > t) &&
         !(raised(span.t_exit, kHitMargin) < t);
}

using AllVolumes = ::testing::Types<AabbVolume, SphereVolume, ObbVolume, KdopVolume<6>,
                                    KdopVolume<14>, KdopVolume<18>, KdopVolume<26>, CylinderVolume,
                                    HullVolume, PrismVolume, ShellVolume, IntersectionVolume>;

struct VolumeNames {
  template <class V>
  static std::string GetName(int) {
    return std::string(info_of(V::kKind).name);
  }
};

}  // namespace strahl::test
