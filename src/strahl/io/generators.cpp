// io/generators.cpp - the list of generators, and their texts "NAME[:SIZE[,key=value...]]".
#include <charconv>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/generator_shapes.h>
#include <strahl/io/generators.h>
#include <strahl/io/spd.h>

namespace strahl {
namespace {

constexpr double kMaxPrimitives = 1e8;

enum class Digits { six, full };

struct SpdOptions {
  Digits precision = Digits::six;
  std::uint64_t seed = 0;
};

OptionTable<SpdOptions> option_fields(const SpdOptions*) {
  return {option("precision", &SpdOptions::precision, {{"g6", Digits::six}, {"full", Digits::full}},
                 "numbers as the SPD program prints them (%g), or unrounded"),
          option("seed", &SpdOptions::seed, "accepted; nothing here is random")};
}

// A generator's text, cut up; the name is known to exist.
struct Request {
  std::string name;
  int size;
  std::vector<OptionValue> options;
};

struct Generator {
  GeneratorInfo info;
  std::function<double(const Request&)> count;       // primitives; also checks the options
  std::function<SceneData(const Request&)> make;     // empty for SPD scenes
  std::function<NffScene(const Request&)> make_nff;  // SPD scenes only
};

Generator spd(GeneratorInfo info, NffScene (*make)(int), double (*count)(double)) {
  info.options = describe_options<SpdOptions>();
  Generator generator{std::move(info), {}, {}, {}};
  generator.count = [count](const Request& request) {
    parse_options<SpdOptions>(request.options, request.name);
    return count(request.size);
  };
  generator.make_nff = [make](const Request& request) {
    NffScene scene = make(request.size);
    const auto options = parse_options<SpdOptions>(request.options, request.name);
    if (options.precision == Digits::six) round_to_six_digits(scene);
    return scene;
  };
  return generator;
}

template <class O>
Generator shape(GeneratorInfo info, SceneData (*make)(int, const O&)) {
  info.options = describe_options<O>();
  Generator generator{std::move(info), {}, {}, {}};
  generator.count = [](const Request& request) {
    return count_triangles(request.size, parse_options<O>(request.options, request.name));
  };
  generator.make = [make](const Request& request) {
    return make(request.size, parse_options<O>(request.options, request.name));
  };
  return generator;
}

double power(double base, double exponent) { return std::pow(base, exponent); }

std::vector<Generator> spd_generators() {
  const auto info = [](const char* name, int size, int max, const char* counts, const char* help) {
    return GeneratorInfo{name, size, 1, max, counts, help, {}};
  };
  // The counts are in primitives after triangulation; a gear has 572 triangles.
  return {
      spd(info("balls", 4, 16, "depth", "sphereflake over a square"), spd_balls,
          [](double s) { return (power(9, s + 1) - 1) / 8 + 2; }),
      spd(info("gears", 4, 1000, "gears along each edge", "cube of meshing gears"), spd_gears,
          [](double s) { return 572 * s * s * s + 2; }),
      spd(info("jacks", 1, 16, "depth", "jacks around jacks, of spheres and cylinders"), spd_jacks,
          [](double s) { return 9 * (power(8, s) - 1) / 7; }),
      spd(info("lattice", 12, 1000, "cells along each edge", "spheres joined by cylinders"),
          spd_lattice, [](double s) { return power(s + 1, 3) + 3 * s * power(s + 1, 2); }),
      spd(info("mount", 6, 15, "subdivisions", "fractal mountain and four spheres"), spd_mount,
          [](double s) { return 2 * power(4, s) + 4; }),
      spd(info("rings", 7, 1000, "layers", "pyramid of ringed dodecahedra"), spd_rings,
          [](double s) { return 10 * s * (s + 1) * (2 * s + 1) + 2; }),
      spd(info("sombrero", 1, 16, "doublings of the 16 x 16 grid", "damped cosine"), spd_sombrero,
          [](double s) { return 2 * power(16 * power(2, s) - 1, 2); }),
      spd(info("teapot", 12, 10000, "steps per patch edge", "teapot on a checkerboard"), spd_teapot,
          [](double s) { return 64 * s * s - 8 * s + 2 * s * s; }),
      spd(info("tetra", 6, 16, "depth", "Sierpinski's tetrahedron"), spd_tetra,
          [](double s) { return power(4, s); }),
      spd(info("tree", 11, 30, "depth", "binary tree of cones and spheres"), spd_tree,
          [](double s) { return 2 * (power(2, s + 1) - 1) + 2; }),
      spd(info("shells", 5, 22, "doublings of 180 spheres", "overlapping spheres on a spiral"),
          spd_shells, [](double s) { return 180 * power(2, s) + 1; }),
  };
}

std::vector<Generator> shape_generators() {
  return {
      shape<IcosphereOptions>({"icosphere",
                               4,
                               0,
                               14,
                               "subdivisions: 20 * 4^size triangles",
                               "closed triangulated sphere",
                               {}},
                              make_icosphere),
      shape<SphereflakeOptions>({"sphereflake",
                                 3,
                                 0,
                                 9,
                                 "depth: (9^(size+1) - 1) / 8 spheres",
                                 "the spheres of balls, triangulated",
                                 {}},
                                make_sphereflake),
      shape<StadiumOptions>({"stadium",
                             600,
                             1,
                             1000000,
                             "stadium's width in teapot widths",
                             "teapot in a stadium of 5,000 triangles",
                             {}},
                            make_stadium),
      shape<SoupOptions>({"soup", 10000, 1, 1000000000, "triangles", "random triangles", {}},
                         make_soup),
      shape<SticksOptions>({"sticks",
                            50,
                            1,
                            100000000,
                            "sticks along x, and as many along y",
                            "thin crossing boxes",
                            {}},
                           make_sticks),
      shape<TerrainOptions>(
          {"terrain", 257, 2, 65537, "vertices along each edge", "fractal height field", {}},
          make_terrain),
  };
}

std::vector<Generator> all_generators() {
  std::vector<Generator> generators = spd_generators();
  for (Generator& generator : shape_generators()) generators.push_back(std::move(generator));
  return generators;
}

const Generator& find_generator(std::span<const Generator> generators, std::string_view name) {
  std::string known;
  for (const Generator& generator : generators) {
    if (generator.info.name == name) return generator;
    known += (known.empty() ? "" : " ") + generator.info.name;
  }
  throw Error(ErrorCode::usage, "unknown generator '" + std::string(name) + "'; known are " + known,
              "gen");
}

int parse_size(std::string_view text, const GeneratorInfo& info) {
  int size = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
  if (error == std::errc{} && end == text.data() + text.size() && info.min_size <= size &&
      size <= info.max_size) {
    return size;
  }
  throw Error(ErrorCode::usage,
              "got size '" + std::string(text) + "', expected a whole number in " +
                  std::to_string(info.min_size) + ".." + std::to_string(info.max_size) + " (" +
                  info.size_help + ")",
              "gen:" + info.name);
}

OptionValue parse_option(std::string_view text, const GeneratorInfo& info) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw Error(ErrorCode::usage, "expected key=value, got '" + std::string(text) + "'",
                "gen:" + info.name);
  }
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

// Reads what follows the name. The size may be left out before options.
Request parse_request(std::string_view arguments, const GeneratorInfo& info) {
  Request request{info.name, info.default_size, {}};
  for (bool first = true; first || !arguments.empty(); first = false) {
    const std::size_t comma = arguments.find(',');
    const std::string_view item = arguments.substr(0, comma);
    if (first && item.find('=') == std::string_view::npos) {
      request.size = parse_size(item, info);
    } else {
      request.options.push_back(parse_option(item, info));
    }
    arguments.remove_prefix(comma == std::string_view::npos ? arguments.size() : comma + 1);
    if (comma != std::string_view::npos && arguments.empty()) parse_option("", info);
  }
  return request;
}

void check_count(double count, std::string_view spec) {
  if (count <= kMaxPrimitives) return;
  throw Error(ErrorCode::resource, "would have more than 100 million primitives",
              std::string(spec));
}

struct Chosen {
  Generator generator;
  Request request;
};

Chosen choose(std::string_view spec) {
  constexpr std::string_view kPrefix = "gen:";
  const std::string_view text = spec.starts_with(kPrefix) ? spec.substr(kPrefix.size()) : spec;
  const std::size_t colon = text.find(':');
  const std::vector<Generator> generators = all_generators();
  const Generator& generator = find_generator(generators, text.substr(0, colon));
  const GeneratorInfo& info = generator.info;
  const Request request = colon == std::string_view::npos
                              ? Request{info.name, info.default_size, {}}
                              : parse_request(text.substr(colon + 1), info);
  check_count(generator.count(request), spec);
  return {generator, request};
}

}  // namespace

std::vector<GeneratorInfo> generator_list() {
  std::vector<GeneratorInfo> list;
  for (Generator& generator : all_generators()) list.push_back(std::move(generator.info));
  return list;
}

SceneData generate_scene(std::string_view spec) {
  const Chosen chosen = choose(spec);
  SceneData data = chosen.generator.make ? chosen.generator.make(chosen.request)
                                         : to_scene_data(chosen.generator.make_nff(chosen.request));
  data.source = spec;
  return data;
}

std::optional<NffScene> generate_nff_scene(std::string_view spec) {
  const Chosen chosen = choose(spec);
  if (!chosen.generator.make_nff) return std::nullopt;
  return chosen.generator.make_nff(chosen.request);
}

}  // namespace strahl
