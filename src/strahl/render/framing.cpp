#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>

#include <strahl/io/text_cursor.h>
#include <strahl/render/camera.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

constexpr double kFovDegrees = 35.0;
/// Empty space around the box.
constexpr double kRoom = 1.04;
/// Below this share of the other two extents a scene counts as flat: lidar, terrain, floor plans.
constexpr double kFlat = 0.55;

bool has_extension(const Scene& scene, std::initializer_list<std::string_view> extensions) {
  const std::string name = to_lower(scene.data().source);
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](std::string_view extension) { return name.ends_with(extension); });
}

/// Right and up of the picture, as shares of the half image, per unit of depth.
struct Spread {
  double x, y;
};

/// How far behind the box's centre the eye must be for a corner to be inside the image.
double needed_distance(const Camera& camera, const Vec3d& corner, Spread spread) {
  const double x = std::abs(dot(corner, camera.right())) / spread.x;
  const double y = std::abs(dot(corner, camera.up())) / spread.y;
  return std::max(x, y) - dot(corner, camera.forward());
}

}  // namespace

Vec3d guess_up(const Scene& scene) {
  if (has_extension(scene, {".gltf", ".glb"})) return {0, 1, 0};
  const Vec3d size = scene.total_bounds().is_empty() ? Vec3d() : scene.total_bounds().extent();
  const bool usually_y = has_extension(scene, {".obj", ".ply", ".off"});
  const double along = usually_y ? size.y : size.z, other = usually_y ? size.z : size.y;
  const bool is_flat_along_other = other < kFlat * std::min(size.x, along);
  return usually_y != is_flat_along_other ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

View frame_box(const Aabb& box, const Vec3d& forward, const Vec3d& up, double fov_degrees,
               int width, int height) {
  View view;
  view.at = box.is_empty() ? Vec3d() : box.center();
  view.up = up, view.fov_degrees = fov_degrees;
  view.width = width, view.height = height;
  view.from = view.at - normalized(forward);
  if (box.is_empty()) return view;

  const Vec3d unit = normalized(forward);
  const Camera camera([&] {
    View centred = view;
    centred.from = Vec3d() - unit, centred.at = {};
    return centred;
  }());
  const double h = std::tan(fov_degrees * (std::numbers::pi / 360.0)) / kRoom;
  const Spread spread{h * width / height, h};
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p{corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                  corner & 4 ? box.hi.z : box.lo.z};
    distance = std::max(distance, needed_distance(camera, p - view.at, spread));
  }
  // A box that is a single point can be seen from anywhere.
  view.from = view.at - unit * (distance > 0.0 ? distance : std::max(1.0, norm_max(view.at)));
  return view;
}

View default_view(const Scene& scene, int width, int height) {
  if (scene.data().view) {
    View view = *scene.data().view;
    view.width = width, view.height = height;
    return view;
  }
  const Vec3d up = guess_up(scene);
  // Files with y upwards have their front towards +z, those with z upwards towards -y.
  const Vec3d forward = up.y > 0.0 ? Vec3d{-0.55, -0.42, -1.0} : Vec3d{-0.55, 1.0, -0.55};
  return frame_box(scene.total_bounds(), forward, up, kFovDegrees, width, height);
}

}  // namespace strahl
