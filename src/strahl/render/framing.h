// render/framing.h - a view for scenes that bring none: the whole scene from above one corner.
#pragma once

#include <strahl/geometry/scene.h>

namespace strahl {

/// The axis the scene takes for upwards, guessed from its format and shape: y for glTF; else a
/// usual axis of the format, or the other of y and z if the scene is flat along that one.
Vec3d guess_up(const Scene& scene);

/// The scene's own view, else one in which its bounding box fits a width x height image.
/// An empty scene gets some view.
View default_view(const Scene& scene, int width, int height);

/// A view along `forward` (any length but 0) in which the whole box fits the image.
View frame_box(const Aabb& box, const Vec3d& forward, const Vec3d& up, double fov_degrees,
               int width, int height);

}  // namespace strahl
