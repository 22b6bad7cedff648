#include <cmath>
#include <numbers>
#include <string>

#include <strahl/base/error.h>
#include <strahl/render/camera.h>

namespace strahl {
namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(ErrorCode::usage, reason, "camera");
}

/// Some coordinate axis that is not along w.
Vec3d other_up(const Vec3d& w) { return std::abs(w.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1}; }

void check(const View& view) {
  if (!is_finite(view.from) || !is_finite(view.at) || !is_finite(view.up))
    refuse("numbers that are not finite");
  if (!(view.fov_degrees > 0.0 && view.fov_degrees < 180.0))
    refuse("field of view of " + std::to_string(view.fov_degrees) +
           " degrees, expected above 0 and below 180");
  if (view.width < 1 || view.height < 1) refuse("an image without pixels");
  const double distance = length(view.at - view.from);
  if (!(distance > 0.0) || !std::isfinite(distance)) refuse("nothing to look at: from equals at");
}

}  // namespace

Camera::Camera(const View& view) {
  check(view);
  eye_ = view.from;
  width_ = view.width, height_ = view.height;
  w_ = normalized(view.at - view.from);
  Vec3d right = cross(w_, view.up);
  if (!(length(right) > 1e-9 * length(view.up))) right = cross(w_, other_up(w_));
  u_ = normalized(right);
  v_ = cross(u_, w_);
  half_height_ = std::tan(view.fov_degrees * (std::numbers::pi / 360.0));
  half_width_ = half_height_ * (static_cast<double>(width_) / height_);
}

Ray Camera::through(double column, double row) const {
  const double x = half_width_ * (2.0 * column / width_ - 1.0);
  const double y = half_height_ * (1.0 - 2.0 * row / height_);
  return {eye_, w_ + x * u_ + y * v_};
}

std::vector<Ray> corner_rays(const Camera& camera) {
  std::vector<Ray> rays;
  rays.reserve((static_cast<std::size_t>(camera.width()) + 1) *
               (static_cast<std::size_t>(camera.height()) + 1));
  for (int row = 0; row <= camera.height(); ++row)
    for (int column = 0; column <= camera.width(); ++column)
      rays.push_back(camera.through(column, row));
  return rays;
}

}  // namespace strahl
