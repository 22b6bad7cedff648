#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string_view>
#include <vector>

#include <strahl/io/text_cursor.h>
#include <strahl/render/camera.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

constexpr double kFovDegrees = 35.0;
/// Empty space around the scene.
constexpr double kRoom = 1.06;
/// Below this share of the other two extents a scene counts as flat: lidar, terrain, floor plans.
constexpr double kFlat = 0.55;

bool has_extension(const Scene& scene, std::initializer_list<std::string_view> extensions) {
  const std::string name = to_lower(scene.data().source);
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](std::string_view extension) { return name.ends_with(extension); });
}

/// Half of the field of view along one axis of the image: which slopes are seen. A point at (x, z)
/// is seen from (c, -d) if |x - c| <= slope (z + d); the largest x - slope z and -x - slope z of
/// all points decide the nearest (c, d).
class Fan {
 public:
  explicit Fan(double slope) : slope_(slope) {}
  void add(double x, double z) {
    right_ = std::max(right_, x - slope_ * z);
    left_ = std::max(left_, -x - slope_ * z);
  }
  double distance() const { return (right_ + left_) / (2.0 * slope_); }
  double center() const { return (right_ - left_) / 2.0; }

 private:
  double slope_, right_ = -Aabb::kInf, left_ = -Aabb::kInf;
};

/// Moves the eye along one axis of the image, from `center`, until there is as much room on one
/// side as on the other: of the two axes only the one that decided the distance is so by itself.
double balanced(const std::vector<Vec3d>& points, int axis, double center, double distance) {
  constexpr int kSteps = 6;
  for (int step = 0; step < kSteps; ++step) {
    double lowest = Aabb::kInf, highest = -Aabb::kInf;
    for (const Vec3d& p : points) {
      const double at = (p[axis] - center) / (p.z + distance);
      lowest = std::min(lowest, at), highest = std::max(highest, at);
    }
    center += 0.5 * (lowest + highest) * distance;
  }
  return center;
}

/// Boxes of at most about kMaxBoxes primitives, evenly chosen.
std::vector<Aabb> sample_boxes(const Scene& scene) {
  constexpr std::uint32_t kMaxBoxes = 50000;
  const std::uint32_t step = 1 + scene.size() / kMaxBoxes;
  std::vector<Aabb> boxes;
  for (std::uint64_t i = 0; i < scene.size(); i += step)
    boxes.push_back(scene.bounds(static_cast<std::uint32_t>(i)));
  return boxes;
}

Vec3d corner_of(const Aabb& box, int corner) {
  return {corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
          corner & 4 ? box.hi.z : box.lo.z};
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

View frame_boxes(std::span<const Aabb> boxes, const Vec3d& forward, const Vec3d& up,
                 double fov_degrees, int width, int height) {
  Aabb whole;
  for (const Aabb& box : boxes) whole.extend(box);
  const Vec3d middle = whole.is_empty() ? Vec3d() : whole.center();
  View view{Vec3d() - normalized(forward), {}, up, fov_degrees, width, height};
  const Camera camera(view);

  std::vector<Vec3d> points;  // right, up, forward from the middle
  for (const Aabb& box : boxes) {
    for (int corner = 0; corner < 8 && !box.is_empty(); ++corner) {
      const Vec3d p = corner_of(box, corner) - middle;
      points.push_back({dot(p, camera.right()), dot(p, camera.up()), dot(p, camera.forward())});
    }
  }
  const double slope = std::tan(fov_degrees * (std::numbers::pi / 360.0)) / kRoom;
  Fan across(slope * width / height), upwards(slope);
  for (const Vec3d& p : points) {
    across.add(p.x, p.z);
    upwards.add(p.y, p.z);
  }
  view.at = middle;
  double distance = 1.0 + norm_max(middle);  // a single point can be seen from anywhere
  if (!whole.is_empty() && whole.lo != whole.hi) {
    distance = std::max(across.distance(), upwards.distance());
    view.at = middle + balanced(points, 0, across.center(), distance) * camera.right() +
              balanced(points, 1, upwards.center(), distance) * camera.up();
  }
  view.from = view.at - distance * camera.forward();
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
  return frame_boxes(sample_boxes(scene), forward, up, kFovDegrees, width, height);
}

}  // namespace strahl
