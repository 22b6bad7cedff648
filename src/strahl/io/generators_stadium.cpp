// io/generators_stadium.cpp - "teapot in a stadium": the scene that breaks uniform grids and
// shallow octrees, because everything of interest lies in one of their cells.
//
// A round stadium of exactly 5,000 triangles, 200 yards across, in metres, z up; a teapot on its
// field, off the centre so that no first split at the middle happens to single it out.
// Layout: circles of 40 points found by rational parametrisation: the same bits on every platform.
#include <array>
#include <cstddef>

#include <strahl/io/generator_mesh.h>
#include <strahl/io/generator_shapes.h>
#include <strahl/io/spd_teapot.h>

namespace strahl {
namespace {

constexpr double kDiameter = 182.88;  // 200 yards
constexpr double kFieldRadius = 45.0, kTopRadius = 85.0, kTopHeight = 25.0;
constexpr std::uint32_t kSegments = 40, kSteps = 30;
constexpr double kTeapotWidth = 6.43;  // of the untouched teapot, handle to spout
const Vec3d kTeapotPlace{17.3, -11.9, 0.0};

enum : std::uint32_t { kConcrete, kEnamel };

// Points of the unit circle, counter-clockwise, 10 in each quarter.
std::array<Vec3d, kSegments> circle() {
  std::array<Vec3d, kSegments> points;
  constexpr std::size_t kQuarter = kSegments / 4;
  for (std::size_t k = 0; k < kQuarter; ++k) {
    const double t = static_cast<double>(k) / kQuarter;
    const double x = (1.0 - t * t) / (1.0 + t * t), y = 2.0 * t / (1.0 + t * t);
    points[k] = {x, y, 0.0};
    points[k + kQuarter] = {-y, x, 0.0};
    points[k + 2 * kQuarter] = {-x, -y, 0.0};
    points[k + 3 * kQuarter] = {y, -x, 0.0};
  }
  return points;
}

struct Stadium {
  MeshParts<double> parts;
  std::array<Vec3d, kSegments> unit = circle();
  std::uint32_t last_ring = 0;

  std::uint32_t add_ring(double radius, double height) {
    last_ring = parts.vertex_count();
    for (const Vec3d& p : unit) parts.vertices.push_back({radius * p.x, radius * p.y, height});
    return last_ring;
  }

  // A band of quads from the last ring to a new one; it faces up or inward where the radius grows.
  void add_band(double radius, double height) {
    const std::uint32_t inner = last_ring, outer = add_ring(radius, height);
    for (std::uint32_t k = 0; k < kSegments; ++k) {
      const std::uint32_t next = (k + 1) % kSegments;
      parts.add_triangle(inner + k, outer + k, outer + next);
      parts.add_triangle(inner + k, outer + next, inner + next);
    }
  }

  void add_field() {
    const std::uint32_t ring = add_ring(kFieldRadius, 0.0);
    const std::uint32_t center = parts.vertex_count();
    parts.vertices.push_back({0.0, 0.0, 0.0});
    for (std::uint32_t k = 0; k < kSegments; ++k) {
      parts.add_triangle(center, ring + k, ring + (k + 1) % kSegments);
    }
  }

  void add_stands() {
    for (std::uint32_t step = 1; step <= kSteps; ++step) {
      const double part = static_cast<double>(step) / kSteps;
      const double height = kTopHeight * part;
      const double before = kFieldRadius + (kTopRadius - kFieldRadius) * (step - 1) / kSteps;
      add_band(before, height);
      add_band(kFieldRadius + (kTopRadius - kFieldRadius) * part, height);
    }
    add_band(0.5 * kDiameter, kTopHeight);
    add_band(0.5 * kDiameter, 0.0);
  }
};

void add_teapot(MeshParts<double>& parts, double width, int steps) {
  const double scale = width / kTeapotWidth;
  for (const spd::TeapotTriangle& triangle : spd::tessellate_teapot(steps)) {
    const std::uint32_t first = parts.vertex_count();
    for (const Vec3d& corner : triangle.corners) {
      parts.vertices.push_back(kTeapotPlace + scale * corner);
    }
    parts.add_triangle(first, first + 1, first + 2);
  }
}

}  // namespace

OptionTable<StadiumOptions> option_fields(const StadiumOptions*) {
  return {option("steps", &StadiumOptions::steps, 1, 1000,
                 "tessellation of the teapot: 64 steps^2 - 8 steps triangles"),
          option("seed", &StadiumOptions::seed, "accepted; nothing here is random")};
}

SceneData make_stadium(int size, const StadiumOptions& options) {
  Stadium stadium;
  stadium.add_field();
  stadium.add_stands();
  MeshParts<double>& parts = stadium.parts;
  parts.materials.assign(parts.indices.size() / 3, kConcrete);
  const double width = kDiameter / size;
  add_teapot(parts, width, options.steps);
  parts.materials.resize(parts.indices.size() / 3, kEnamel);

  SceneData data = scene_of(std::move(parts));
  data.materials = {Material{}, Material{{1.0, 0.5, 0.1}, 0.75, 0.25, 30.0, 0.0, 1.0}};
  const Vec3d middle = kTeapotPlace + Vec3d{0.0, 0.0, 0.22 * width};
  data.view = View{middle + width * Vec3d{0.9, 1.4, 0.7}, middle, {0, 0, 1}, 45.0, 512, 512};
  data.lights = {{-40.0, 60.0, 90.0}, {70.0, 20.0, 60.0}};
  return data;
}

double count_triangles(int, const StadiumOptions& options) {
  const double steps = options.steps;
  return 5000.0 + 64.0 * steps * steps - 8.0 * steps;
}

}  // namespace strahl
