// bounds/polytope.h - the convex body that half-spaces cut out of a box: measures and corners.
//
// Method:     every plane keeps its own face, a polygon clipped by all others
//             ([SutherlandHodgman1974] in the plane): O(faces) per plane added. Faces do not know
//             each other, so nothing can come apart.
// Accuracy:   areas and volumes within about 1e-12 of those of the box.
// Thread safety: values.
#pragma once

#include <vector>

#include <strahl/bounds/enclosed_set.h>

namespace strahl {

class Polytope {
 public:
  enum class Use { measure, corners };

  /// @param box bounds the body; finite
  /// @param use corners: all planes are moved out a little, so that the hull of the corners
  ///   encloses the body in spite of rounding
  explicit Polytope(const Aabb& box, Use use = Use::measure);
  /// Leaves n.x <= offset; n need not be unit but is not 0.
  void add(const Vec3d& n, double offset);

  struct Measure {
    double half_area = 0.0, volume = 0.0;
  };
  Measure measure() const;
  void add_corners_to(EnclosedSet& set) const;

  /// Largest n.x in the body; -infinity if nothing is left.
  double support(const Vec3d& n) const;

 private:
  /// Unit normal and offset from center_, moved out by margin_.
  struct Face {
    Vec3d n;
    double offset;
    std::vector<Vec3d> polygon;
  };
  std::vector<Face> faces_;
  std::vector<Vec3d> spare_;
  Vec3d center_;
  double size_, margin_;
};

}  // namespace strahl
