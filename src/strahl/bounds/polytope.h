// bounds/polytope.h - the convex body that a set of half-spaces cuts out of a box: its measures.
//
// Method:     each plane's face is a large square clipped by all other half-spaces
// ([SutherlandHodgman1974]
//             in the plane), O(planes^2). Faces do not know each other, so nothing can come apart.
// Accuracy:   areas and volumes within about 1e-12 of those of the box's size.
// Thread safety: values.
#pragma once

#include <vector>

#include <strahl/bounds/enclosed_set.h>

namespace strahl {

/// n.x <= offset; n need not be unit but is not 0.
struct HalfSpace {
  Vec3d n;
  double offset;
};

class Polytope {
 public:
  /// @param box bounds the body; finite
  explicit Polytope(const Aabb& box);
  void add(const Vec3d& n, double offset);

  struct Measure {
    double half_area = 0.0, volume = 0.0;
  };
  Measure measure() const;
  /// Corners whose hull encloses the body: of the one with every plane moved out a little.
  void add_corners_to(EnclosedSet& set) const;

 private:
  /// Corners of plane i's face with all planes moved out by `margin`.
  std::vector<Vec3d> face(std::size_t i, double margin) const;
  std::vector<HalfSpace> planes_;  ///< unit normals, relative to center_
  Vec3d center_;
  double size_;
};

}  // namespace strahl
