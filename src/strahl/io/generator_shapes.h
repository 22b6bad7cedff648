// io/generator_shapes.h - generated triangle scenes beside the SPD: their options and functions.
//
// Only correctly rounded operations (+ - * / sqrt) and the project's random numbers are used, so
// the vertices are the same bits on every platform.
// Thread safety: pure functions.
#pragma once

#include <cstdint>

#include <strahl/base/options.h>
#include <strahl/geometry/scene.h>

namespace strahl {

struct IcosphereOptions {
  double radius = 1.0;
  double ox = 0.0, oy = 0.0, oz = 0.0;
  double offset = 0.0;
  std::uint64_t seed = 0;
};
OptionTable<IcosphereOptions> option_fields(const IcosphereOptions*);

/// A closed sphere of 20 * 4^size triangles, outward winding, float32 vertices, shared indices.
SceneData make_icosphere(int size, const IcosphereOptions& options);
double count_triangles(int size, const IcosphereOptions& options);

struct SphereflakeOptions {
  int level = 2;
  bool floor = false;
  std::uint64_t seed = 0;
};
OptionTable<SphereflakeOptions> option_fields(const SphereflakeOptions*);

/// The spheres of SPD balls as icospheres: (9^(size+1) - 1) / 8 of them.
SceneData make_sphereflake(int size, const SphereflakeOptions& options);
double count_triangles(int size, const SphereflakeOptions& options);

struct StadiumOptions {
  int steps = 12;
  std::uint64_t seed = 0;
};
OptionTable<StadiumOptions> option_fields(const StadiumOptions*);

/// A finely tessellated teapot, its longest extent 1/size of the diameter of the stadium around it.
SceneData make_stadium(int size, const StadiumOptions& options);
double count_triangles(int size, const StadiumOptions& options);

struct SoupOptions {
  double edge = 0.05;
  std::uint64_t seed = 0;
};
OptionTable<SoupOptions> option_fields(const SoupOptions*);

/// `size` random triangles: one corner uniform in the unit cube, the others near it.
SceneData make_soup(int size, const SoupOptions& options);
double count_triangles(int size, const SoupOptions& options);

enum class StickTurn { none, deg30, deg45 };

struct SticksOptions {
  double width = 0.02;
  double jitter = 0.3;
  StickTurn turn = StickTurn::none;
  std::uint64_t seed = 0;
};
OptionTable<SticksOptions> option_fields(const SticksOptions*);

/// `size` long thin boxes along x crossing as many along y, all near the plane z = 0.
SceneData make_sticks(int size, const SticksOptions& options);
double count_triangles(int size, const SticksOptions& options);

struct TerrainOptions {
  double extent = 100.0;
  double height = 20.0;
  double roughness = 0.5;
  std::uint64_t seed = 0;
};
OptionTable<TerrainOptions> option_fields(const TerrainOptions*);

/// A height field of size x size vertices over a square, z up.
SceneData make_terrain(int size, const TerrainOptions& options);
double count_triangles(int size, const TerrainOptions& options);

}  // namespace strahl
