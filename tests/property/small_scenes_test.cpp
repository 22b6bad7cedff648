// Small scenes of small integers, where everything coincides: generated, and shrunk when they fail.
#include <array>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace strahl::test {
namespace {

using Point = std::array<int, 3>;

rc::Gen<Point> points(int reach) {
  return rc::gen::container<Point>(rc::gen::inRange(-reach, reach + 1));
}

Integers integers(const Point& p) { return {p[0], p[1], p[2]}; }

using Corners = std::array<Point, 3>;

/// Triangles that have an area; others are never hit and have no place in the integer rule.
IntegerMesh mesh_of(const std::vector<Corners>& triangles) {
  IntegerMesh mesh;
  for (const auto& [a, b, c] : triangles) {
    const IntegerTriangle t{integers(a), integers(b), integers(c)};
    if (cross_of(minus(t.b, t.a), minus(t.c, t.a)) != Integers{}) mesh.push_back(t);
  }
  return mesh;
}

RC_GTEST_PROP(SmallScenes, EveryStructureListsTheHitsOfTheIntegerRule, ()) {
  const auto triangles =
      *rc::gen::container<std::vector<Corners>>(rc::gen::container<Corners>(points(2)));
  const IntegerMesh mesh = mesh_of(triangles);
  const Integers org = integers(*points(3)), dir = integers(*points(2));
  RC_PRE(dir != Integers{});
  std::vector<IntegerHit> expected = integer_crossings(org, dir, mesh);
  std::erase_if(expected, [](const IntegerHit& hit) { return hit.t < 0; });
  const Ray ray{as_vector(org), as_vector(dir)};
  for (const auto& structure : build_all(scene_of(as_mesh(mesh)))) {
    std::vector<IntegerHit> hits;
    for (const Hit& hit : all_hits(*structure, make_batch({&ray, 1})).hits)
      hits.push_back({hit.t, hit.id.prim, hit.is_front});
    RC_ASSERT(hits == expected);
    const std::uint32_t first = hits.empty() ? kNoId : hits.front().triangle;
    RC_ASSERT(structure->closest_hit(ray).id.prim == first);
  }
}

/// The line through a tetrahedron: an even number of crossings, one ahead from inside.
RC_GTEST_PROP(SmallScenes, ATetrahedronIsCrossedAnEvenNumberOfTimes, ()) {
  const std::array<Point, 4> p = *rc::gen::container<std::array<Point, 4>>(points(3));
  const Integers a = integers(p[0]), b = integers(p[1]), c = integers(p[2]), d = integers(p[3]);
  const std::int64_t volume = dot_of(minus(d, a), cross_of(minus(b, a), minus(c, a)));
  RC_PRE(volume != 0);
  const IntegerMesh mesh{{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
  const Integers dir = integers(*points(3)), far = integers(*points(9));
  RC_PRE(dir != Integers{});
  const Ray outside{as_vector(far) + Vec3d{20, 0, 0}, as_vector(dir)};
  const Ray inside{0.25 * as_vector({a[0] + b[0] + c[0] + d[0], a[1] + b[1] + c[1] + d[1],
                                     a[2] + b[2] + c[2] + d[2]}),
                   as_vector(dir)};
  for (const auto& structure : build_all(scene_of(as_mesh(mesh)))) {
    const std::uint32_t count = hit_counts(*structure, make_batch({&outside, 1}))[0];
    RC_ASSERT(count % 2 == 0u);
    RC_ASSERT(count <= 2u);
    RC_ASSERT(hit_counts(*structure, make_batch({&inside, 1}))[0] == 1u);
    RC_ASSERT(sides_of(*structure, make_batch({&inside, 1}))[0] == Side::inside);
    RC_ASSERT(sides_of(*structure, make_batch({&outside, 1}))[0] == Side::outside);
  }
}

}  // namespace
}  // namespace strahl::test
