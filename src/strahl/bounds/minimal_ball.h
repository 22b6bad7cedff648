// bounds/minimal_ball.h - smallest enclosing balls.
//
// Papers:     [Welzl1991] with move-to-front; [Gaertner1999]: it runs on a few witnesses only, to
//             which the farthest point is added until none is farther. [Ritter1990]: two passes.
// Accuracy:   of points: the minimum to about 1e-14 of the radius. Of balls, for which Welzl's
//             recursion can fail, the witnesses are their farthest points (cutting planes): within
//             1e-10. The result encloses its input up to rounding.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/bounds/enclosed_set.h>

namespace strahl {

/// Radius 0 at the origin for nothing. Points in a plane give the ball around their smallest
/// circle.
Ball minimal_ball(std::span<const Vec3d> points, std::span<const Ball> balls = {});

/// From one far point to another, then grown by each that sticks out: no more than about a fifth
/// larger than the minimum in practice, in two passes.
Ball ritter_ball(std::span<const Vec3d> points, std::span<const Ball> balls = {});

}  // namespace strahl
