// io/generators_random.cpp - scenes made with random numbers: soup, sticks, terrain.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include <strahl/base/hash.h>
#include <strahl/base/rng.h>
#include <strahl/io/generator_mesh.h>
#include <strahl/io/generator_shapes.h>

namespace strahl {
namespace {

Vec3d uniform_vector(Rng& rng, double low, double high) {
  const double x = rng.uniform(low, high), y = rng.uniform(low, high);
  return {x, y, rng.uniform(low, high)};
}

// Unit vectors of the two stick directions.
std::array<Vec3d, 2> stick_directions(StickTurn turn) {
  double cosine = 1.0, sine = 0.0;
  if (turn == StickTurn::deg30) cosine = std::sqrt(0.75), sine = 0.5;
  if (turn == StickTurn::deg45) cosine = sine = std::sqrt(0.5);
  return {Vec3d{cosine, sine, 0.0}, Vec3d{-sine, cosine, 0.0}};
}

// A square field of (2^k + 1)^2 heights filled by midpoint displacement.
class HeightField {
 public:
  HeightField(std::size_t side, const TerrainOptions& options)
      : side_(side), options_(options), heights_(side * side, 0.0) {
    double amplitude = options.height;
    for (std::size_t step = side - 1; step > 1; step /= 2) {
      raise_centers(step, amplitude);
      raise_edges(step, amplitude);
      amplitude *= options.roughness;
    }
  }

  double at(std::size_t x, std::size_t y) const { return heights_[y * side_ + x]; }

 private:
  // Uniform in [-1, 1), a function of seed and place alone.
  double noise(std::size_t x, std::size_t y) const {
    Hash64 hash;
    hash.add(options_.seed);
    hash.add(static_cast<std::uint64_t>(x));
    hash.add(static_cast<std::uint64_t>(y));
    return static_cast<double>(hash.digest() >> 11) * 0x1p-52 - 1.0;
  }

  void set(std::size_t x, std::size_t y, double mean, double amplitude) {
    heights_[y * side_ + x] = mean + amplitude * noise(x, y);
  }

  void raise_centers(std::size_t step, double amplitude) {
    const std::size_t half = step / 2;
    for (std::size_t y = half; y < side_; y += step) {
      for (std::size_t x = half; x < side_; x += step) {
        const double sum = (at(x - half, y - half) + at(x + half, y - half)) +
                           (at(x - half, y + half) + at(x + half, y + half));
        set(x, y, sum / 4.0, amplitude);
      }
    }
  }

  void raise_edges(std::size_t step, double amplitude) {
    const std::size_t half = step / 2;
    for (std::size_t y = 0; y < side_; y += half) {
      for (std::size_t x = (y / half) % 2 == 0 ? half : 0; x < side_; x += step) {
        set(x, y, mean_of_neighbours(x, y, half), amplitude);
      }
    }
  }

  // On the border only three of the four exist.
  double mean_of_neighbours(std::size_t x, std::size_t y, std::size_t half) const {
    double sum = 0.0;
    int count = 0;
    const auto add = [&](bool exists, std::size_t nx, std::size_t ny) {
      if (!exists) return;
      sum += at(nx, ny);
      ++count;
    };
    add(x >= half, x - half, y);
    add(x + half < side_, x + half, y);
    add(y >= half, x, y - half);
    add(y + half < side_, x, y + half);
    return sum / count;
  }

  std::size_t side_;
  TerrainOptions options_;
  std::vector<double> heights_;
};

}  // namespace

void add_box(MeshParts<float>& parts, const Vec3d& center, const std::array<Vec3d, 3>& half_axes) {
  const std::uint32_t first = parts.vertex_count();
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p = center;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = ((corner >> axis) & 1) != 0;
      p = upper ? p + half_axes[axis] : p - half_axes[axis];
    }
    parts.vertices.emplace_back(p);
  }
  // Bit k of a corner's number: the upper side of axis k. Each face from its lowest corner.
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kFaces) {
    parts.add_triangle(first + a, first + b, first + c);
    parts.add_triangle(first + a, first + c, first + d);
  }
}

OptionTable<SoupOptions> option_fields(const SoupOptions*) {
  return {option("edge", &SoupOptions::edge, 1e-9, 1e9,
                 "largest distance of the other corners from the first, per axis"),
          option("seed", &SoupOptions::seed, "of the random numbers")};
}

SceneData make_soup(int size, const SoupOptions& options) {
  Rng rng(options.seed);
  MeshParts<float> parts;
  for (int i = 0; i < size; ++i) {
    const std::uint32_t first = parts.vertex_count();
    const Vec3d corner = uniform_vector(rng, 0.0, 1.0);
    parts.vertices.emplace_back(corner);
    for (int k = 0; k < 2; ++k) {
      parts.vertices.emplace_back(corner + uniform_vector(rng, -options.edge, options.edge));
    }
    parts.add_triangle(first, first + 1, first + 2);
  }
  return scene_of(std::move(parts));
}

double count_triangles(int size, const SoupOptions&) { return size; }

OptionTable<SticksOptions> option_fields(const SticksOptions*) {
  return {option("width", &SticksOptions::width, 1e-6, 1.0, "of a stick, in spacings"),
          option("jitter", &SticksOptions::jitter, 0.0, 10.0,
                 "largest random shift per axis, in spacings"),
          option("rotate", &SticksOptions::turn,
                 {{"0", StickTurn::none}, {"30", StickTurn::deg30}, {"45", StickTurn::deg45}},
                 "degrees about z"),
          option("seed", &SticksOptions::seed, "of the random numbers")};
}

SceneData make_sticks(int size, const SticksOptions& options) {
  Rng rng(options.seed);
  const std::array<Vec3d, 2> direction = stick_directions(options.turn);
  const double half_length = 0.5 * size, half_width = 0.5 * options.width;
  MeshParts<float> parts;
  for (std::size_t d = 0; d < 2; ++d) {
    const Vec3d along = direction[d], across = d == 0 ? direction[1] : -direction[0];
    for (int i = 0; i < size; ++i) {
      const Vec3d center =
          (i + 0.5 - half_length) * across + uniform_vector(rng, -options.jitter, options.jitter);
      add_box(parts, center, {half_length * along, half_width * across, {0, 0, half_width}});
    }
  }
  return scene_of(std::move(parts));
}

double count_triangles(int size, const SticksOptions&) { return 24.0 * size; }

OptionTable<TerrainOptions> option_fields(const TerrainOptions*) {
  return {option("extent", &TerrainOptions::extent, 1e-9, 1e9, "length of the square's sides"),
          option("height", &TerrainOptions::height, 0.0, 1e9,
                 "largest displacement of the first level"),
          option("roughness", &TerrainOptions::roughness, 0.0, 1.0,
                 "displacement of a level relative to the one before"),
          option("seed", &TerrainOptions::seed, "of the random numbers")};
}

SceneData make_terrain(int size, const TerrainOptions& options) {
  const auto n = static_cast<std::size_t>(size);
  const HeightField field(std::bit_ceil(n - 1) + 1, options);
  MeshParts<float> parts;
  for (std::size_t y = 0; y < n; ++y) {
    for (std::size_t x = 0; x < n; ++x) {
      const auto place = [&](std::size_t k) {
        return options.extent * (static_cast<double>(k) / static_cast<double>(n - 1) - 0.5);
      };
      parts.vertices.emplace_back(Vec3d{place(x), place(y), field.at(x, y)});
    }
  }
  const auto row = static_cast<std::uint32_t>(n);
  for (std::uint32_t y = 0; y + 1 < row; ++y) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t corner = y * row + x;
      parts.add_triangle(corner, corner + 1, corner + row + 1);
      parts.add_triangle(corner, corner + row + 1, corner + row);
    }
  }
  return scene_of(std::move(parts));
}

double count_triangles(int size, const TerrainOptions&) {
  return 2.0 * (size - 1.0) * (size - 1.0);
}

}  // namespace strahl
