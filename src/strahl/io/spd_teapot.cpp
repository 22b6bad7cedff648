// io/spd_teapot.cpp - SPD "teapot": the tessellated teapot on a checkerboard.
#include <cmath>
#include <cstddef>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>
#include <strahl/io/spd_teapot.h>
#include <strahl/io/spd_teapot_data.h>

namespace strahl {
namespace {

using Weights = std::array<double, 4>;
using Matrix = std::array<Weights, 4>;

// Rows: coefficient of u^3, u^2, u, 1 in each of the four cubic Bernstein polynomials. Symmetric.
constexpr Matrix kBezier{{{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}};

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) product[i][j] += a[i][k] * b[k][j];
    }
  }
  return product;
}

Weights powers(double u) { return {u * u * u, u * u, u, 1.0}; }
Weights slopes(double u) { return {3.0 * (u * u), 2.0 * u, 1.0, 0.0}; }

// A patch as polynomials in (row parameter, column parameter), one matrix per coordinate.
struct Patch {
  std::array<Matrix, 3> coefficient;

  explicit Patch(const std::array<std::uint16_t, 16>& control) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Matrix points;
      for (std::size_t i = 0; i < 16; ++i) {
        points[i / 4][i % 4] = spd::kTeapotPoint[control[i]][axis];
      }
      coefficient[axis] = kBezier * points * kBezier;
    }
  }

  Vec3d evaluate(const Weights& row, const Weights& column) const {
    Vec3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      for (std::size_t j = 0; j < 4; ++j) {
        double along = 0.0;
        for (std::size_t i = 0; i < 4; ++i) along += row[i] * coefficient[axis][i][j];
        sum += along * column[j];
      }
      p[static_cast<int>(axis)] = sum;
    }
    return p;
  }

  Vec3d normal(double s, double t) const {
    const Vec3d along_row = evaluate(slopes(s), powers(t));
    const Vec3d along_column = evaluate(powers(s), slopes(t));
    return normalized(cross(along_column, along_row));
  }
};

bool is_on_axis(const Vec3d& p) { return std::abs(p.x) < 1e-4 && std::abs(p.y) < 1e-4; }

// Where a patch has shrunk to a point on the axis the surface has no normal: it gets the axis'.
// False for a triangle that shrinks altogether.
bool repair_tip(spd::TeapotTriangle& triangle) {
  int tips = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!is_on_axis(triangle.corners[i])) continue;
    ++tips;
    triangle.normals[i] = {0.0, 0.0, triangle.corners[i].z > 1.5 ? 1.0 : -1.0};
  }
  return tips < 2;
}

void add_cell(std::vector<spd::TeapotTriangle>& triangles, const Patch& patch, int i, int j,
              int steps) {
  const auto parameter = [steps](int k) { return static_cast<double>(k) / steps; };
  constexpr std::array<std::array<int, 2>, 4> kAround{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};
  for (std::size_t half = 0; half < 2; ++half) {
    spd::TeapotTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<int, 2>& corner = kAround[(k + 2 * half) % 4];
      const double s = parameter(i + corner[0]), t = parameter(j + corner[1]);
      triangle.corners[k] = patch.evaluate(powers(s), powers(t));
      triangle.normals[k] = patch.normal(s, t);
    }
    if (repair_tip(triangle)) triangles.push_back(triangle);
  }
}

// The squares of one colour: those with an odd column + row for parity 1.
void add_squares(NffScene& scene, int size, int parity) {
  const auto edge = [size](int k) { return 4.0 * (2.0 * k / size - 1.0); };
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) {
      if ((i + j) % 2 != parity) continue;
      scene.add_polygon(std::array<Vec3d, 4>{Vec3d{edge(i), edge(j), 0.0},
                                             {edge(i + 1), edge(j), 0.0},
                                             {edge(i + 1), edge(j + 1), 0.0},
                                             {edge(i), edge(j + 1), 0.0}});
    }
  }
}

}  // namespace

std::vector<spd::TeapotTriangle> spd::tessellate_teapot(int steps) {
  std::vector<TeapotTriangle> triangles;
  for (const std::array<std::uint16_t, 16>& control : kTeapotPatch) {
    const Patch patch(control);
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) add_cell(triangles, patch, i, j, steps);
    }
  }
  return triangles;
}

NffScene spd_teapot(int size) {
  NffScene scene = spd::stage({4.86, 7.2, 5.4}, {0, 0, 0}, {0, 0, 1}, 45.0, 1.0,
                              {{-3.1, 9.8, 12.1}, {11.3, 5.1, 8.8}});
  scene.add_fill({{1, 1, 1}, 0.5, 0.5, 4.81884, 0.0, 0.0});
  add_squares(scene, size, 1);
  scene.add_fill({{0.5, 0.5, 0.5}, 0.5, 0.5, 4.81884, 0.0, 0.0});
  add_squares(scene, size, 0);
  scene.add_fill({{1.0, 0.5, 0.1}, 0.75, 0.25, spd::kGlossy, 0.0, 0.0});
  for (const spd::TeapotTriangle& triangle : spd::tessellate_teapot(size)) {
    scene.add_patch(triangle.corners, triangle.normals);
  }
  return scene;
}

}  // namespace strahl
