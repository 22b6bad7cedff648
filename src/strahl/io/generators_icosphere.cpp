// io/generators_icosphere.cpp - spheres made by subdividing an icosahedron.
//
// Layout:  every face is a triangular lattice of n = 2^level steps a side; lattice points on
// corners
//          and edges are shared by their global numbers: 12 corners, n - 1 points on each of 30
//          edges, then the interiors of the 20 faces.
// Invariants: a vertex depends on two vertices only through their sum, so both faces at an edge
// find
//          the same bits for its points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <strahl/io/generator_mesh.h>
#include <strahl/io/generator_shapes.h>

namespace strahl {
namespace {

struct Icosahedron {
  std::array<Vec3d, 12> corners;
  std::vector<std::array<std::uint32_t, 3>> faces;        // 20, outward
  std::array<std::array<std::uint32_t, 12>, 12> edges{};  // number of the edge between two corners
};

bool are_neighbours(const Vec3d& a, const Vec3d& b) {
  // Edges have length 2; the next distance is 2 * 1.618.
  return dot(a - b, a - b) < 4.5;
}

std::array<Vec3d, 12> icosahedron_corners() {
  const double golden = (1.0 + std::sqrt(5.0)) / 2.0;
  std::array<Vec3d, 12> corners;
  std::size_t next = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double one : {-1.0, 1.0}) {
      for (const double phi : {-golden, golden}) {
        corners[next][(axis + 1) % 3] = one;
        corners[next][(axis + 2) % 3] = phi;
        ++next;
      }
    }
  }
  return corners;
}

Icosahedron make_icosahedron() {
  Icosahedron ico;
  ico.corners = icosahedron_corners();
  const auto& p = ico.corners;
  std::uint32_t edge = 0;
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      if (!are_neighbours(p[a], p[b])) continue;
      ico.edges[a][b] = ico.edges[b][a] = edge++;
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!are_neighbours(p[a], p[c]) || !are_neighbours(p[b], p[c])) continue;
        const bool outward = dot(cross(p[a], p[b]), p[c]) > 0.0;
        ico.faces.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
      }
    }
  }
  for (Vec3d& corner : ico.corners) corner = normalized(corner);
  return ico;
}

// The lattice over the faces: point (i, j) is i steps towards the second corner of the face and j
// towards the third.
class Lattice {
 public:
  Lattice(const Icosahedron& ico, std::uint32_t steps) : ico_(ico), n_(steps) {}

  std::uint32_t vertex_count() const { return 10 * n_ * n_ + 2; }

  std::uint32_t vertex(std::uint32_t face, std::uint32_t i, std::uint32_t j) const {
    const auto& [a, b, c] = ico_.faces[face];
    if (j == 0) return on_edge(a, b, i);
    if (i == 0) return on_edge(a, c, j);
    if (i + j == n_) return on_edge(b, c, j);
    // Rows j = 1, 2, ... of the interior have n - 2, n - 3, ... points.
    const std::uint32_t before = (j - 1) * (n_ - 1) - (j - 1) * j / 2;
    return 12 + 30 * (n_ - 1) + face * ((n_ - 1) * (n_ - 2) / 2) + before + (i - 1);
  }

 private:
  std::uint32_t on_edge(std::uint32_t from, std::uint32_t to, std::uint32_t k) const {
    if (k == 0) return from;
    if (k == n_) return to;
    const std::uint32_t from_lower = from < to ? k : n_ - k;
    return 12 + ico_.edges[from][to] * (n_ - 1) + (from_lower - 1);
  }

  const Icosahedron& ico_;
  std::uint32_t n_;
};

// Fills in the lattice points of a face from coarse to fine, each between two coarser ones.
void place_vertices(std::vector<Vec3d>& vertices, const Lattice& lattice, std::uint32_t face,
                    std::uint32_t n) {
  const auto point = [&](std::uint32_t i, std::uint32_t j) -> Vec3d& {
    return vertices[lattice.vertex(face, i, j)];
  };
  for (std::uint32_t h = n / 2; h > 0; h /= 2) {
    for (std::uint32_t j = 0; j <= n; j += h) {
      for (std::uint32_t i = 0; i + j <= n; i += h) {
        const bool odd_i = (i & h) != 0, odd_j = (j & h) != 0;
        if (!odd_i && !odd_j) continue;
        const std::uint32_t di = odd_i ? h : 0, dj = odd_j ? h : 0;
        // Both odd: the point halves a side parallel to the one from the second to the third
        // corner.
        const Vec3d sum = odd_i && odd_j ? point(i + di, j - dj) + point(i - di, j + dj)
                                         : point(i + di, j + dj) + point(i - di, j - dj);
        point(i, j) = normalized(sum);
      }
    }
  }
}

void add_triangles(MeshParts<double>& parts, const Lattice& lattice, std::uint32_t face,
                   std::uint32_t n) {
  const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return lattice.vertex(face, i, j); };
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i + j < n; ++i) {
      parts.add_triangle(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
      if (i + j + 1 == n) continue;
      parts.add_triangle(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
}

}  // namespace

MeshParts<double> unit_icosphere(int level) {
  const Icosahedron ico = make_icosahedron();
  const std::uint32_t n = std::uint32_t{1} << level;
  const Lattice lattice(ico, n);
  MeshParts<double> parts;
  parts.vertices.resize(lattice.vertex_count());
  std::copy(ico.corners.begin(), ico.corners.end(), parts.vertices.begin());
  parts.indices.reserve(60 * static_cast<std::size_t>(n) * n);
  for (std::uint32_t face = 0; face < 20; ++face) {
    place_vertices(parts.vertices, lattice, face, n);
    add_triangles(parts, lattice, face, n);
  }
  return parts;
}

double icosphere_triangles(int level) { return 20.0 * std::ldexp(1.0, 2 * level); }

OptionTable<IcosphereOptions> option_fields(const IcosphereOptions*) {
  constexpr double kFar = 1e30;
  return {option("radius", &IcosphereOptions::radius, 1e-30, kFar, "radius"),
          option("ox", &IcosphereOptions::ox, -kFar, kFar, "centre, x"),
          option("oy", &IcosphereOptions::oy, -kFar, kFar, "centre, y"),
          option("oz", &IcosphereOptions::oz, -kFar, kFar, "centre, z"),
          option("offset", &IcosphereOptions::offset, -kFar, kFar,
                 "added to all three coordinates of the centre"),
          option("seed", &IcosphereOptions::seed, "accepted; nothing here is random")};
}

SceneData make_icosphere(int size, const IcosphereOptions& options) {
  MeshParts<double> unit = unit_icosphere(size);
  const Vec3d center = Vec3d{options.ox, options.oy, options.oz} + Vec3d::all(options.offset);
  MeshParts<float> parts;
  parts.vertices.reserve(unit.vertices.size());
  for (const Vec3d& p : unit.vertices) parts.vertices.emplace_back(center + options.radius * p);
  parts.indices = std::move(unit.indices);
  return scene_of(std::move(parts));
}

double count_triangles(int size, const IcosphereOptions&) { return icosphere_triangles(size); }

}  // namespace strahl
