// Closed solids in integers: rays through vertices, along edges, in planes of faces and from the
// surface itself have exactly the hits of the rule, through every structure and under instances.
#include <cmath>
#include <string>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

#include <strahl/geometry/triangle.h>

namespace strahl::test {
namespace {

constexpr std::size_t kRays = 30000;

struct Solid {
  const char* name;
  IntegerMesh mesh;
  std::int64_t (*side)(const Integers&);  ///< negative inside, 0 on the surface
};

Solid cube() {
  return {"cube", integer_cube(2), [](const Integers& p) {
            return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) - 2;
          }};
}
Solid octahedron() {
  return {"octahedron", integer_octahedron(3),
          [](const Integers& p) { return std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]) - 3; }};
}

struct IntegerRay {
  Integers org, dir;
};

Integers random_integers(Rng& rng, std::uint32_t reach) {
  const auto draw = [&] { return std::int64_t{rng.below(2 * reach + 1)} - reach; };
  const std::int64_t x = draw(), y = draw();
  return {x, y, draw()};
}

std::vector<IntegerRay> random_rays(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<IntegerRay> rays;
  while (rays.size() < count) {
    const Integers org = random_integers(rng, 4), dir = random_integers(rng, 3);
    if (dir != Integers{}) rays.push_back({org, dir});
  }
  return rays;
}

std::vector<Ray> mapped(const std::vector<IntegerRay>& rays, const Affine& map) {
  std::vector<Ray> made;
  for (const IntegerRay& r : rays)
    made.push_back({map.point(as_vector(r.org)), map.vector(as_vector(r.dir))});
  return made;
}

/// What must hold for any ray of a closed convex solid, by the side of its origin.
void expect_count_of_convex(std::int64_t side, std::size_t ahead) {
  ASSERT_TRUE(side >= 0 || ahead == 1) << ahead;
  ASSERT_TRUE(side <= 0 || ahead == 0 || ahead == 2) << ahead;
}

class Solids : public testing::TestWithParam<Solid (*)()> {};

TEST_P(Solids, TheRuleItselfCrossesTheSurfaceOnceFromInsideAndNotOrTwiceFromOutside) {
  const Solid solid = GetParam()();
  for (const IntegerRay& ray : random_rays(kRays, 1)) {
    const auto hits = integer_crossings(ray.org, ray.dir, solid.mesh);
    const auto ahead = std::count_if(hits.begin(), hits.end(), [](auto& h) { return h.t > 0; });
    const auto at_zero = std::count_if(hits.begin(), hits.end(), [](auto& h) { return h.t == 0; });
    ASSERT_EQ(hits.size() % 2, 0u);
    expect_count_of_convex(solid.side(ray.org), static_cast<std::size_t>(ahead));
    ASSERT_TRUE(at_zero == 0 || solid.side(ray.org) == 0);
    if (HasFatalFailure()) return;
  }
}

TEST_P(Solids, TheTriangleTestFindsTheCrossingsOfTheWholeLine) {
  const Solid solid = GetParam()();
  RayFrame frame;
  frame.bounds = {{-3, -3, -3}, {3, 3, 3}};
  for (const IntegerRay& r : random_rays(kRays / 3, 2)) {
    const PreparedRay ray({as_vector(r.org), as_vector(r.dir)}, frame);
    std::vector<IntegerHit> hits;
    for (std::uint32_t i = 0; i < solid.mesh.size(); ++i) {
      const auto& [a, b, c] = solid.mesh[i];
      const auto hit = intersect(ray, {as_vector(a), as_vector(b), as_vector(c)});
      if (hit) hits.push_back({hit->t, i, hit->is_front});
    }
    std::sort(hits.begin(), hits.end());
    ASSERT_EQ(hits, integer_crossings(r.org, r.dir, solid.mesh));
  }
}

/// Maps that neither round vertices nor rays: mirrored, stretched, turned, moved far away.
std::vector<Affine> exact_maps() {
  Affine turned;
  turned.m = {{{0, 0, -1, 5}, {1, 0, 0, 0}, {0, 1, 0, -7}}};
  return {Affine{},
          Affine::scaling({-1, 1, 1}),
          Affine::scaling({2, -0.25, 8}),
          Affine::translation({1024, -512, 3}) * Affine::scaling({0.5, 4, -1}),
          turned,
          Affine::translation({0x1p30, 0x1p30, 0x1p30}) * turned};
}

TEST_P(Solids, EveryStructureListsTheCrossingsUnderMapsThatDoNotRound) {
  const Solid solid = GetParam()();
  const std::vector<IntegerRay> rays = random_rays(kRays, 3);
  std::vector<std::vector<IntegerHit>> expected(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (const IntegerHit& h : integer_crossings(rays[i].org, rays[i].dir, solid.mesh))
      if (h.t >= 0) expected[i].push_back(h);
  for (const Affine& map : exact_maps()) {
    const std::vector<Ray> world = mapped(rays, map);
    for (const auto& structure : build_all(scene_of(as_mesh(solid.mesh), {map}))) {
      SCOPED_TRACE(structure->spec());
      const AllHits all = all_hits(*structure, make_batch(world));
      for (std::size_t i = 0; i < rays.size(); ++i) {
        std::vector<IntegerHit> hits;
        for (const Hit& h : hits_of(all, i)) hits.push_back({h.t, h.id.prim, h.is_front});
        ASSERT_EQ(hits, expected[i]) << "ray " << i;
      }
    }
  }
}

/// Turned by angles that no double holds, and stretched on top.
std::vector<Affine> rounding_maps() {
  const Affine turned = Affine::rotation(0.5 * std::sin(0.4), 0.5 * std::sin(0.4),
                                         std::sqrt(0.5) * std::sin(0.4), std::cos(0.4));
  return {turned, Affine::translation({100.1, -3, 1e4}) * turned,
          turned * Affine::scaling({-1.3, 0.7, 5})};
}

TEST_P(Solids, InstancesThatRoundRaysStillNeitherLeakNorCountTwice) {
  const Solid solid = GetParam()();
  const std::vector<IntegerRay> rays = random_rays(kRays, 4);
  for (const Affine& map : rounding_maps()) {
    const std::vector<Ray> world = mapped(rays, map);
    for (const auto& structure : build_all(scene_of(as_mesh(solid.mesh), {map}))) {
      SCOPED_TRACE(structure->spec());
      const auto counts = hit_counts(*structure, make_batch(world));
      for (std::size_t i = 0; i < rays.size(); ++i) {
        expect_count_of_convex(solid.side(rays[i].org), counts[i]);
        if (HasFatalFailure()) FAIL() << "ray " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Convex, Solids, testing::Values(&cube, &octahedron),
                         [](const testing::TestParamInfo<Solid (*)()>& i) {
                           return std::string(i.param().name);
                         });

// --- a cube from outside: through it exactly 2, along it 0 or 2, past it 0
// ------------------------

enum class Passage { misses, touches, enters };

/// How the ray from outside passes [-2, 2]^3, by its slabs in exact fractions n / d, d > 0.
Passage passage(const IntegerRay& ray) {
  struct Fraction {
    std::int64_t n, d;
    std::int64_t compare(const Fraction& o) const { return n * o.d - o.n * d; }
  };
  Fraction enter{0, 1}, leave{1000, 1};
  bool is_strict = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t o = ray.org[axis], d = ray.dir[axis];
    if (d == 0) {
      if (std::abs(o) > 2) return Passage::misses;
      is_strict = is_strict && std::abs(o) < 2;
      continue;
    }
    const std::int64_t s = d > 0 ? 1 : -1;
    const Fraction first{-2 - s * o, s * d}, last{2 - s * o, s * d};
    if (first.compare(enter) > 0) enter = first;
    if (last.compare(leave) < 0) leave = last;
  }
  const std::int64_t depth = leave.compare(enter);
  if (depth < 0) return Passage::misses;
  return depth > 0 && is_strict ? Passage::enters : Passage::touches;
}

/// From outside to every lattice point of the cube's edges, corners among them.
std::vector<IntegerRay> rays_at_edges_and_corners(std::size_t count) {
  Rng rng(6);
  const Solid solid = cube();
  std::vector<IntegerRay> rays;
  while (rays.size() < count) {
    Integers target = random_integers(rng, 2);
    const std::size_t axis = rng.below(3);
    target[(axis + 1) % 3] = rng.below(2) ? 2 : -2, target[(axis + 2) % 3] = rng.below(2) ? 2 : -2;
    const Integers org = random_integers(rng, 9);
    if (solid.side(org) > 0) rays.push_back({org, minus(target, org)});
  }
  return rays;
}

TEST(CubeFromOutside, ThroughAnEdgeOrCornerCountsTwoAndATouchNoneOrTwo) {
  const std::vector<IntegerRay> rays = rays_at_edges_and_corners(kRays);
  std::array<std::size_t, 3> seen{};
  for (const IntegerRay& ray : rays) ++seen[static_cast<std::size_t>(passage(ray))];
  ASSERT_EQ(seen[static_cast<std::size_t>(Passage::misses)], 0u);
  ASSERT_GT(seen[static_cast<std::size_t>(Passage::touches)], kRays / 10);
  ASSERT_GT(seen[static_cast<std::size_t>(Passage::enters)], kRays / 10);
  for (const Affine& map : exact_maps()) {
    const std::vector<Ray> world = mapped(rays, map);
    for (const auto& structure : build_all(scene_of(as_mesh(cube().mesh), {map}))) {
      SCOPED_TRACE(structure->spec());
      const auto counts = hit_counts(*structure, make_batch(world));
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool enters = passage(rays[i]) == Passage::enters;
        ASSERT_TRUE(counts[i] == 2 || (counts[i] == 0 && !enters)) << "ray " << i;
      }
    }
  }
}

TEST(CubeFromOutside, RandomRaysCountByTheirPassage) {
  const Solid solid = cube();
  const std::vector<IntegerRay> all = random_rays(kRays, 7);
  for (const auto& structure : build_all(scene_of(as_mesh(solid.mesh)))) {
    const auto counts = hit_counts(*structure, make_batch(mapped(all, {})));
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (solid.side(all[i].org) <= 0) continue;
      const Passage how = passage(all[i]);
      ASSERT_TRUE(how != Passage::enters || counts[i] == 2) << i;
      ASSERT_TRUE(how != Passage::misses || counts[i] == 0) << i;
    }
  }
}

}  // namespace
}  // namespace strahl::test
