// bounds_table_bench - bounding volumes around ten real parts: what they contain, their volumes,
// and how near oriented boxes come to the smallest.
//
//   bounds_table_bench FOLDER_OF_SCENES [POINTS] [ORIENTATIONS]
//
// Containment: all vertices and POINTS random points of the surface (a million) against every kind,
// fitted fast and thoroughly; V::contains() has no margin. Volumes are those of thorough fits in
// the cubed units of the part. Oriented boxes: volume over that of the smallest of ORIENTATIONS
// random ones (10,000).
// Exit status: 1 when a point is outside or a thorough box is above 1.05 times the smallest.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <tests/support/random_axes.h>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>
#include <strahl/bounds/obb_fit.h>
#include <strahl/io/load.h>
#include <strahl/math/affine.h>

namespace {

using namespace strahl;

constexpr double kWorstBox = 1.05;

const std::vector<std::string> kParts{"1002_tray_bottom.STL", "ADIS16480.STL",
                                      "extruder-body.stl",    "cycloidal.ply",
                                      "stanford-bunny.ply",   "dragon_vrip_res3.ply",
                                      "teapot.obj",           "spot.obj",
                                      "suzanne.obj",          "bamboo.ply"};

struct RealPart {
  std::string name;
  std::vector<TriangleVertices> triangles;
  EnclosedSet set;
};

RealPart load(const std::string& folder, const std::string& name) {
  RealPart part{name, {}, {}};
  const SceneData data = load_scene_data(folder + "/" + name);
  for (const Geometry& g : data.geometries)
    for (std::size_t i = 0; i < g.mesh.size(); ++i) part.triangles.push_back(g.mesh[i]);
  for (const TriangleVertices& t : part.triangles) part.set.add(t);
  return part;
}

/// All corners, and random points of random triangles.
std::vector<Vec3d> points_of(const RealPart& part, std::size_t count) {
  Rng rng(1);
  std::vector<Vec3d> points;
  for (const TriangleVertices& t : part.triangles)
    for (const Vec3d& p : {t.a, t.b, t.c}) points.push_back(p);
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleVertices& t =
        part.triangles[rng.below(static_cast<std::uint32_t>(part.triangles.size()))];
    // Weights of few bits: no rounding moves the mixture of float corners off the triangle.
    double u = rng.below(1025) / 1024.0, v = rng.below(1025) / 1024.0;
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    points.push_back((1.0 - u - v) * t.a + u * t.b + v * t.c);
  }
  return points;
}

template <class V>
std::size_t count_outside(const V& volume, const std::vector<Vec3d>& points) {
  std::size_t outside = 0;
  for (const Vec3d& p : points) outside += !volume.contains(p);
  return outside;
}

struct Tally {
  std::size_t tested = 0, outside = 0;
};

/// Prints the row of volumes and adds to what is contained, per kind.
void print_volumes(const RealPart& part, const std::vector<Vec3d>& points,
                   std::vector<Tally>& tallies) {
  std::printf("| %s |", part.name.c_str());
  for (std::size_t k = 0; k < kBoundingVolumes.size(); ++k)
    with_volume_type(kBoundingVolumes[k].kind, [&]<class V>() {
      const V thorough = V::enclose(part.set, FitEffort::thorough);
      tallies[k].outside += count_outside(thorough, points) +
                            count_outside(V::enclose(part.set, FitEffort::fast), points);
      tallies[k].tested += 2 * points.size();
      std::printf(" %.4g |", thorough.volume());
    });
  std::printf("\n");
  std::fflush(stdout);
}

double smallest_of_random(const EnclosedSet& set, std::size_t orientations) {
  const FitCloud cloud(set, true);
  Rng rng(2);
  double least = Aabb::kInf;
  for (std::size_t i = 0; i < orientations; ++i) {
    double volume = cloud.scale * cloud.scale * cloud.scale;
    for (const Vec3d& axis : test::random_axes(rng)) {
      const auto [lo, hi] = cloud.extent(axis);
      volume *= hi - lo;
    }
    least = std::min(least, volume);
  }
  return least;
}

/// The worse of the two thorough boxes over the smallest of random ones.
double print_boxes(const RealPart& part, std::size_t orientations) {
  const double least = smallest_of_random(part.set, orientations);
  const auto ratio = [&](FitEffort effort, ObbGoal goal) {
    return ObbVolume::enclose(part.set, effort, goal).volume() / least;
  };
  const double volume = ratio(FitEffort::thorough, ObbGoal::volume),
               area = ratio(FitEffort::thorough, ObbGoal::area);
  std::printf("| %s | %.4g | %.3f | %.3f | %.3f | %.3f |\n", part.name.c_str(), least, volume, area,
              ratio(FitEffort::fast, ObbGoal::volume),
              ObbVolume::enclose_by_covariance(part.set).volume() / least);
  std::fflush(stdout);
  return std::max(volume, area);
}

void print_rule(std::size_t columns) {
  for (std::size_t i = 0; i < columns; ++i) std::printf("|---");
  std::printf("|\n");
}

bool print_tables(const std::vector<RealPart>& parts, std::size_t points,
                  std::size_t orientations) {
  std::vector<Tally> tallies(kBoundingVolumes.size());
  std::printf("volumes\n\n| part |");
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    std::printf(" %s |", std::string(info.name).c_str());
  std::printf("\n");
  print_rule(1 + kBoundingVolumes.size());
  for (const RealPart& part : parts) print_volumes(part, points_of(part, points), tallies);
  std::printf("\npoints outside\n\n| kind | points | outside |\n");
  print_rule(3);
  bool holds = true;
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    std::printf("| %s | %zu | %zu |\n", std::string(kBoundingVolumes[k].name).c_str(),
                tallies[k].tested, tallies[k].outside);
    holds = holds && tallies[k].outside == 0;
  }
  std::printf("\noriented boxes over the smallest of %zu random orientations\n\n", orientations);
  std::printf("| part | smallest | least volume | least area | fast | covariance |\n");
  print_rule(6);
  for (const RealPart& part : parts) holds = print_boxes(part, orientations) <= kWorstBox && holds;
  return holds;
}

std::size_t number(int argc, char** argv, int i, std::size_t otherwise) {
  return i < argc ? std::strtoul(argv[i], nullptr, 10) : otherwise;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: bounds_table_bench FOLDER_OF_SCENES [POINTS] [ORIENTATIONS]\n");
    return 2;
  }
  std::vector<RealPart> parts;
  for (const std::string& name : kParts) parts.push_back(load(argv[1], name));
  const bool holds =
      print_tables(parts, number(argc, argv, 2, 1'000'000), number(argc, argv, 3, 10'000));
  if (!holds) std::fprintf(stderr, "a point is outside, or an oriented box is too large\n");
  return holds ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
