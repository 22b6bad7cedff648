// Hits of curved primitives lie within their outlines, also of lines that graze or run along them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/cone.h>
#include <strahl/geometry/mesh.h>
#include <strahl/geometry/outline.h>
#include <strahl/geometry/sphere.h>

namespace strahl {
namespace {

Vec3d any(Rng& rng, double reach = 1.0) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

/// How far a point is outside of the hull of one or two balls, by many of the balls between.
double outside(const Vec3d& p, const Outline& outline) {
  const Ball &a = outline.ball[0], &b = outline.ball[outline.count - 1];
  double least = HUGE_VAL;
  for (int i = 0; i <= 256; ++i) {
    const double s = i / 256.0;
    const Vec3d center = a.center + s * (b.center - a.center);
    least = std::min(least, length(p - center) - (a.radius + s * (b.radius - a.radius)));
  }
  return least;
}

TEST(Outline, HoldsHitsOfConesOfAllSlopes) {
  Rng rng(1);
  int hits = 0;
  for (int i = 0; i < 6000; ++i) {
    const Vec3d base = any(rng),
                axis = std::ldexp(1.0, -static_cast<int>(rng.below(10))) * any(rng);
    const double wide = std::ldexp(1.0, -static_cast<int>(rng.below(10)));
    const double end = i % 3 == 0 ? 0.0 : i % 3 == 1 ? wide : wide * rng.uniform();
    const Cone cone{base, wide, base + axis, end};
    const Outline outline = outline_of(cone);
    ASSERT_TRUE(outline.count == 1 || outline.count == 2);
    const double size = std::max(norm_max(axis), wide);
    // Through a point of the rim, along a generator or nearly so, or anywhere.
    const Vec3d across = normalized(cross(axis, any(rng)));
    const Vec3d rim = base + wide * across, generator = base + axis + end * across - rim;
    const Vec3d sideways = normalized(cross(generator, across));
    for (int k = 0; k < 6; ++k) {
      const double off = k == 0 ? 0.0 : size * std::ldexp(1.0, -static_cast<int>(rng.below(50)));
      const Vec3d dir = k < 4 ? generator + off * any(rng, k % 2) : any(rng);
      const Vec3d through = k < 3 ? rim + off * sideways : rim + off * any(rng);
      const double before = std::ldexp(1.0, static_cast<int>(rng.below(12))) - 1.0;
      const Vec3d org = through - before * dir;
      const CurvedHits found = intersect(cone, org, dir);
      for (int h = 0; h < found.count; ++h, ++hits) {
        const Vec3d p = org + found.hit[static_cast<std::size_t>(h)].t * dir;
        // Between the balls looked at the hull bulges by at most what 256 steps leave.
        ASSERT_LT(outside(p, outline), size * 0x1p-9 + 1e-12) << i << ' ' << k;
      }
    }
  }
  EXPECT_GT(hits, 5000);
}

TEST(Outline, MirroredTrianglesKeepTheirFront) {
  const TriangleVertices tri{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto normal = [](const Outline& o) {
    return cross(o.ball[1].center - o.ball[0].center, o.ball[2].center - o.ball[0].center);
  };
  EXPECT_EQ(normal(outline_of(tri, {})), (Vec3d{0, 0, 1}));
  EXPECT_EQ(normal(outline_of(tri, Affine::scaling({-1, 1, 1}))), (Vec3d{0, 0, 1}));
  EXPECT_EQ(normal(outline_of(tri, Affine::scaling({1, 1, -1}))), (Vec3d{0, 0, -1}));
}

}  // namespace
}  // namespace strahl
