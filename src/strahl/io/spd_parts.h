// io/spd_parts.h - what several of the SPD scenes share: rotations, the stage, a ground square.
#pragma once

#include <initializer_list>
#include <numbers>

#include <strahl/io/nff_scene.h>

namespace strahl::spd {

inline constexpr double kPi = std::numbers::pi;

/// Shine exponents as the SPD program prints them; 100000 stands for "no highlight".
inline constexpr double kDull = 100000.0;
inline constexpr double kGlossy = 3.0827;

/// Turns by `radians` about an axis (0 x, 1 y, 2 z), counter-clockwise seen from its tip.
Affine rotation(int axis, double radians);

/// An empty scene with view and lights, 512 x 512 pixels and the usual blue background.
NffScene stage(const Vec3d& from, const Vec3d& at, const Vec3d& up, double fov_degrees,
               double hither, std::initializer_list<Vec3d> lights);

/// The polygon |x|, |y| <= half at height z, facing +z.
void add_ground(NffScene& scene, double half, double z);

}  // namespace strahl::spd
