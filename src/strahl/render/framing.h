// render/framing.h - a view for scenes that bring none: the whole scene from above one corner.
#pragma once

#include <span>

#include <strahl/geometry/scene.h>

namespace strahl {

/// The axis the scene takes for upwards, guessed from its format and shape: y for glTF; else a
/// usual axis of the format, or the other of y and z if the scene is flat along that one.
Vec3d guess_up(const Scene& scene);

/// The scene's own view, else one from above one corner in which all of it fits a width x height
/// image. An empty scene gets some view.
View default_view(const Scene& scene, int width, int height);

/// The nearest view along `forward` (any length but 0) in which all boxes fit the image, with some
/// room around. Empty boxes do not count. O(boxes).
View frame_boxes(std::span<const Aabb> boxes, const Vec3d& forward, const Vec3d& up,
                 double fov_degrees, int width, int height);

}  // namespace strahl
