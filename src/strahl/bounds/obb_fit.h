// bounds/obb_fit.h - axes of oriented boxes.
//
// Papers:     covariance of the hull's surface [Gottschalk1996]; rotating calipers [Toussaint1983]:
//             with one axis given, the best rectangle across it has a side on an edge of the
//             projected hull. The search takes the axis from covariance, far points, fixed
//             directions and (thorough) the faces of the hull, on one of which the box of least
//             volume usually lies, then improves axes one at a time and by small turns.
// Thread safety: pure functions.
#pragma once

#include <array>

#include <strahl/bounds/fit.h>

namespace strahl {

/// What a box is to have little of.
enum class ObbGoal { area, volume };

/// Unit and orthogonal up to rounding.
using ObbAxes = std::array<Vec3d, 3>;

ObbAxes covariance_axes(const FitCloud& cloud);

/// The near-minimal search.
ObbAxes search_axes(const FitCloud& cloud, ObbGoal goal, FitEffort effort);

/// Surface or volume of the box around the cloud, in its units.
double box_cost(const Vec3d& widths, ObbGoal goal);

/// Unit normals of the hull's faces, largest areas first, near-equal ones once, at most `most`.
std::vector<Vec3d> face_normals(const FitCloud& cloud, std::size_t most);

}  // namespace strahl
