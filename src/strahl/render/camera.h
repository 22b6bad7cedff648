// render/camera.h - rays through the pixels of a perspective view.
//
// Convention (that of the standard scenes): w points from the eye to what is looked at, u = w x up
// to the right, v = u x w upwards, all of unit length. The ray through column c and row r of a
// width x height image, in pixels from the top left corner, has the direction
// w + x u + y v, x = a h (2c / width - 1), y = h (1 - 2r / height), h = tan(fov / 2), a the aspect.
// Corner rays have whole c = 0..width, r = 0..height; pixel centres lie at halves.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

class Camera {
 public:
  /// Uses the view's size. Throws Error{usage}: fov not in (0, 180), numbers not finite, eye and
  /// target the same, no pixels. An up vector along the view is replaced by a coordinate axis.
  explicit Camera(const View& view);

  /// The ray through a point of the image, in pixels from its top left corner.
  Ray through(double column, double row) const;

  int width() const { return width_; }
  int height() const { return height_; }
  const Vec3d& eye() const { return eye_; }
  const Vec3d& right() const { return u_; }
  const Vec3d& up() const { return v_; }
  const Vec3d& forward() const { return w_; }

 private:
  Vec3d eye_, u_, v_, w_;
  double half_width_, half_height_;  ///< of the image at distance 1
  int width_, height_;
};

/// One ray per pixel corner, (width + 1) * (height + 1), row by row from the top left: the test
/// image of the standard scenes.
std::vector<Ray> corner_rays(const Camera& camera);

}  // namespace strahl
