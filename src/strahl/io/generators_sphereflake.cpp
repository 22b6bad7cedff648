// io/generators_sphereflake.cpp - the sphereflake of SPD balls as a triangle mesh.
//
// The directions are the same as in spd_balls.cpp, but found without sines and cosines, so that the
// mesh is the same on every platform.
#include <array>
#include <cmath>
#include <cstddef>

#include <strahl/io/generator_mesh.h>
#include <strahl/io/generator_shapes.h>

namespace strahl {
namespace {

constexpr double kRootRadius = 0.5;

// The rotation about a unit axis, by its sine and cosine, applied to v (Rodrigues).
Vec3d turned(const Vec3d& v, const Vec3d& axis, double sine, double cosine) {
  return cosine * v + sine * cross(axis, v) + (1.0 - cosine) * dot(axis, v) * axis;
}

std::array<Vec3d, 9> directions_around_up() {
  const Vec3d up{0, 0, 1}, axis = normalized(Vec3d{1, -1, 0});
  const double sine = 2.0 / std::sqrt(6.0), cosine = std::sqrt(1.0 / 3.0);
  const std::array<Vec3d, 3> trio{Vec3d{1, 1, 0}, {1, 0, -1}, {0, 1, -1}};
  std::array<Vec3d, 9> directions;
  for (std::size_t k = 0; k < 3; ++k) {
    directions[k] = turned(normalized(trio[k]), axis, sine, cosine);
    for (std::size_t third = 3; third < 9; third += 3) {
      directions[k + third] = turned(directions[k + third - 3], up, std::sqrt(0.75), -0.5);
    }
  }
  return directions;
}

// Takes v along by the rotation that turns up into the unit vector `direction`.
Vec3d turned_from_up(const Vec3d& v, const Vec3d& direction) {
  if (direction.z >= 0.9999) return v;
  if (direction.z <= -0.9999) return {-v.x, v.y, -v.z};
  const Vec3d across = cross(Vec3d{0, 0, 1}, direction);
  const double sine = length(across);
  return turned(v, across / sine, sine, direction.z);
}

struct Flake {
  MeshParts<double> unit;
  std::array<Vec3d, 9> around_up;
  MeshParts<float> parts;

  void add_sphere(const Vec3d& center, double radius) {
    const std::uint32_t first = parts.vertex_count();
    for (const Vec3d& p : unit.vertices) parts.vertices.emplace_back(center + radius * p);
    for (const std::uint32_t index : unit.indices) parts.indices.push_back(first + index);
  }

  void add(int depth, const Vec3d& center, double radius, const Vec3d& direction) {
    add_sphere(center, radius);
    if (depth == 0) return;
    for (const Vec3d& up_direction : around_up) {
      const Vec3d child = normalized(turned_from_up(up_direction, direction));
      add(depth - 1, center + (radius * 4.0 / 3.0) * child, radius / 3.0, child);
    }
  }
};

void add_floor(MeshParts<float>& parts) {
  const std::uint32_t first = parts.vertex_count();
  for (const auto& [x, y] :
       {std::array{12.0f, 12.0f}, {-12.0f, 12.0f}, {-12.0f, -12.0f}, {12.0f, -12.0f}}) {
    parts.vertices.emplace_back(x, y, -0.5f);
  }
  parts.add_triangle(first, first + 1, first + 2);
  parts.add_triangle(first, first + 2, first + 3);
}

}  // namespace

OptionTable<SphereflakeOptions> option_fields(const SphereflakeOptions*) {
  return {option("level", &SphereflakeOptions::level, 0, 8,
                 "subdivision of each sphere: 20 * 4^level triangles"),
          option("floor", &SphereflakeOptions::floor, "the square of SPD balls below it"),
          option("seed", &SphereflakeOptions::seed, "accepted; nothing here is random")};
}

SceneData make_sphereflake(int size, const SphereflakeOptions& options) {
  Flake flake{unit_icosphere(options.level), directions_around_up(), {}};
  flake.add(size, {0, 0, 0}, kRootRadius, {0, 0, 1});
  if (options.floor) add_floor(flake.parts);
  return scene_of(std::move(flake.parts));
}

double count_triangles(int size, const SphereflakeOptions& options) {
  const double spheres = (std::pow(9.0, size + 1) - 1.0) / 8.0;
  return spheres * icosphere_triangles(options.level) + (options.floor ? 2.0 : 0.0);
}

}  // namespace strahl
