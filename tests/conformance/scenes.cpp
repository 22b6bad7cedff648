#include <cmath>
#include <limits>
#include <map>
#include <tests/conformance/scenes.h>

#include <strahl/base/rng.h>

namespace strahl::test {
namespace {

/// Triangles collected corner by corner, without sharing.
struct Soup {
  std::vector<Vec3d> vertices;
  void add(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    vertices.insert(vertices.end(), {a, b, c});
  }
  void quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    add(a, b, c), add(a, c, d);
  }
  template <class T>
  Geometry geometry() const {
    std::vector<Vec3<T>> v;
    std::vector<std::uint32_t> indices;
    for (const Vec3d& p : vertices) {
      indices.push_back(static_cast<std::uint32_t>(v.size()));
      v.push_back(Vec3<T>(p));
    }
    Geometry g;
    g.mesh = make_mesh(std::move(v), std::move(indices));
    return g;
  }
};

SceneData single(Geometry g) {
  SceneData data;
  data.geometries.push_back(std::move(g));
  return data;
}

Vec3d random_point(Rng& rng) {
  const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
  return {x, y, rng.uniform(-1, 1)};
}

Soup random_soup(int count, double edge, const Vec3d& shift, std::uint64_t seed) {
  Rng rng(seed);
  Soup soup;
  for (int i = 0; i < count; ++i) {
    const Vec3d p = random_point(rng) + shift;
    soup.add(p, p + edge * random_point(rng), p + edge * random_point(rng));
  }
  return soup;
}

Soup box_soup(const Vec3d& lo, const Vec3d& hi) {
  const auto at = [&](int i) {
    return Vec3d{i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
  };
  Soup soup;
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) soup.quad(at(f[0]), at(f[1]), at(f[2]), at(f[3]));
  return soup;
}

/// Walls on integer planes: every split plane and cell border coincides with geometry.
SceneData lattice_of_walls(double step, double offset) {
  Soup soup;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k <= 4; ++k)
      for (int u = 0; u < 4; ++u)
        for (int v = 0; v < 4; ++v) {
          const auto at = [&](int du, int dv) {
            Vec3d p;
            p[axis] = k * step + offset;
            p[(axis + 1) % 3] = (u + du) * step + offset;
            p[(axis + 2) % 3] = (v + dv) * step + offset;
            return p;
          };
          soup.quad(at(0, 0), at(1, 0), at(1, 1), at(0, 1));
        }
  return single(soup.geometry<float>());
}

/// Thin tiles in planes that no binary grid meets.
SceneData tiles_off_the_grid() {
  Soup soup;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const double x = 0.1 * i, y = 0.1 * j, z = 0.3 * ((i + j) % 3);
      soup.quad({x, y, z}, {x + 0.1, y, z}, {x + 0.1, y + 0.1, z}, {x, y + 0.1, z});
    }
  return single(soup.geometry<double>());
}

SceneData fan_around_a_vertex() {
  Soup soup;
  constexpr int kSpokes = 400;
  for (int i = 0; i < kSpokes; ++i) {
    const double a = 2 * M_PI * i / kSpokes, b = 2 * M_PI * (i + 1) / kSpokes;
    soup.add({0, 0, 0.5}, {std::cos(a), std::sin(a), 0}, {std::cos(b), std::sin(b), 0});
  }
  return single(soup.geometry<float>());
}

SceneData slivers() {
  Rng rng(11);
  Soup soup;
  for (int i = 0; i < 300; ++i) {
    const Vec3d a = random_point(rng), along = 2.0 * random_point(rng);
    soup.add(a, a + along, a + 0.5 * along + std::ldexp(1.0, -(i % 30)) * random_point(rng));
  }
  return single(soup.geometry<float>());
}

SceneData copies_of_one(int count) {
  Soup soup;
  for (int i = 0; i < count; ++i) soup.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0.25});
  return single(soup.geometry<float>());
}

SceneData every_triangle_twice() {
  Soup soup = random_soup(150, 0.7, {}, 12);
  const std::vector<Vec3d> once = soup.vertices;
  for (std::size_t i = 0; i < once.size(); i += 3)
    i % 2 ? soup.add(once[i], once[i + 1], once[i + 2])
          : soup.add(once[i + 1], once[i], once[i + 2]);
  return single(soup.geometry<float>());
}

SceneData flat_scene() {
  Rng rng(13);
  Soup soup;
  for (int i = 0; i < 200; ++i) {
    Vec3d p[3];
    for (Vec3d& v : p) v = random_point(rng), v.z = 0.25;
    soup.add(p[0], p[1], p[2]);
  }
  return single(soup.geometry<float>());
}

SceneData refused_among_good() {
  Soup soup = random_soup(60, 0.8, {}, 14);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = Aabb::kInf;
  soup.add({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  soup.add({0, 0, 0}, {0, 0, 0}, {1, 0, 0});
  soup.add({nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
  soup.add({0, inf, 0}, {1, 0, 0}, {0, 1, 0});
  soup.add({-1, -1, 0.1}, {1, -1, 0.1}, {0, 1, 0.1});
  return single(soup.geometry<float>());
}

SceneData huge_beside_tiny() {
  Rng rng(15);
  Soup soup = random_soup(100, 0.001, {}, 15);
  soup.add({-1e6, -1e6, -1.5}, {1e6, -1e6, -1.5}, {0, 1e6, -1.5});
  soup.add({-1e6, 2, -1e6}, {1e6, 2, -1e6}, {0, 2.5, 1e6});
  for (int i = 0; i < 50; ++i) {
    const Vec3d p = 1e-6 * random_point(rng);
    soup.add(p, p + 1e-7 * random_point(rng), p + 1e-7 * random_point(rng));
  }
  return single(soup.geometry<double>());
}

Geometry octasphere(int level, double radius, const Vec3d& shift) {
  Soup soup;
  const int n = 1 << level;
  const auto on_sphere = [&](double x, double y, double z) {
    return shift + radius * normalized(Vec3d{x, y, z});
  };
  for (int s = 0; s < 8; ++s) {
    const double sx = s & 1 ? -1 : 1, sy = s & 2 ? -1 : 1, sz = s & 4 ? -1 : 1;
    const bool flip = sx * sy * sz < 0;
    const auto at = [&](int i, int j) { return on_sphere(sx * i, sy * j, sz * (n - i - j)); };
    const auto face = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
      flip ? soup.add(a, c, b) : soup.add(a, b, c);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j + i < n; ++j) {
        face(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < n) face(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  return soup.geometry<float>();
}

SceneData curved_mix() {
  Rng rng(16);
  Geometry spheres, cones;
  spheres.kind = PrimitiveKind::sphere, spheres.geometry_id = 1;
  cones.kind = PrimitiveKind::cone, cones.geometry_id = 2;
  for (int i = 0; i < 80; ++i) {
    spheres.spheres.push_back({random_point(rng), 0.02 + 0.4 * rng.uniform()});
    const Vec3d base = random_point(rng);
    cones.cones.push_back({base, 0.2 * rng.uniform(), base + 0.6 * random_point(rng),
                           i % 3 == 0 ? 0.0 : 0.2 * rng.uniform()});
  }
  spheres.spheres.push_back({{0, 0, 0}, 1.0});
  spheres.spheres.push_back({{0, 0, 0}, 1.0});
  spheres.spheres.push_back({{0, 0, 0}, -1.0});
  cones.cones.push_back({{0, 0, -1}, 0.5, {0, 0, 1}, 0.5});
  SceneData data = single(random_soup(40, 0.7, {}, 17).geometry<float>());
  data.geometries.push_back(std::move(spheres));
  data.geometries.push_back(std::move(cones));
  return data;
}

Affine random_map(Rng& rng, double shift) {
  Affine map = Affine::translation(shift * random_point(rng)) *
               Affine::scaling({0.3 + rng.uniform(), 0.3 + rng.uniform(), -0.3 - rng.uniform()});
  Vec3d axis = normalized(random_point(rng));
  const double angle = 3 * rng.uniform();
  axis = std::sin(angle) * axis;
  return map * Affine::rotation(axis.x, axis.y, axis.z, std::cos(angle));
}

/// Mirrored, sheared, stretched and identity instances of triangles, spheres and cones.
SceneData instances(double shift) {
  SceneData data = curved_mix();
  data.geometries.push_back(octasphere(2, 0.5, {}));
  data.geometries.back().geometry_id = 3;
  data.instances.push_back({0, 3, {}, 0});
  Rng rng(18);
  for (std::uint32_t i = 1; i < 6; ++i) data.instances.push_back({3, 1, random_map(rng, shift), i});
  data.instances.push_back({0, 2, random_map(rng, shift), 6});
  Affine stretched = Affine::translation({0, 0, shift}) * Affine::scaling({1000, 1e-3, 1});
  data.instances.push_back({3, 1, stretched, 7});
  return data;
}

std::vector<NamedScene> make_list() {
  const Vec3d far{1000, -2000, 3000};
  return {
      {"empty", [] { return SceneData{}; }, true},
      {"one_triangle", [] { return copies_of_one(1); }, true},
      {"cube",
       [] {
         return single(box_soup({-1, -1, -1}, {1, 1, 1}).geometry<float>());
       },
       true},
      {"identical", [] { return copies_of_one(200); }, false},
      {"lattice_of_walls", [] { return lattice_of_walls(1.0, 0.0); }, false},
      {"lattice_off_grid", [] { return lattice_of_walls(0.1, 1000.1); }, false},
      {"tiles_off_the_grid", tiles_off_the_grid, false},
      {"fan_around_a_vertex", fan_around_a_vertex, false},
      {"slivers", slivers, false},
      {"every_triangle_twice", every_triangle_twice, false},
      {"flat", flat_scene, false},
      {"refused_among_good", refused_among_good, false},
      {"huge_beside_tiny", huge_beside_tiny, false},
      {"soup", [] { return single(random_soup(800, 0.3, {}, 19).geometry<float>()); }, false},
      {"soup_far", [=] { return single(random_soup(400, 0.5, far, 20).geometry<float>()); }, false},
      {"soup_very_far",
       [] {
         return single(random_soup(300, 0.9, {1e6, 1e6, -1e6}, 21).geometry<float>());
       },
       false},
      {"closed_sphere", [] { return single(octasphere(4, 1.0, {})); }, false},
      {"closed_sphere_far",
       [] {
         return single(octasphere(3, 10.0, {1e5, 1e5, 1e5}));
       },
       false},
      {"curved_mix", curved_mix, false},
      {"instances", [] { return instances(1.0); }, false},
      {"instances_far", [] { return instances(1e5); }, false},
  };
}

}  // namespace

const std::vector<NamedScene>& adversarial_scenes() {
  static const std::vector<NamedScene> list = make_list();
  return list;
}

std::shared_ptr<const Scene> scene_of(const NamedScene& named) {
  static std::map<std::string, std::shared_ptr<const Scene>> cache;
  auto& scene = cache[named.name];
  if (!scene) scene = std::make_shared<const Scene>(named.make());
  return scene;
}

}  // namespace strahl::test
