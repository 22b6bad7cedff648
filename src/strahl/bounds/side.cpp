#include <algorithm>
#include <cmath>

#include <strahl/bounds/side.h>

namespace strahl {
namespace {

/// Straight pieces on a quarter of a circle are about 12: the area they miss is below 0.3 %.
constexpr double kPerRadius = 16.0;
/// Of what is narrow in its volume, no more pieces than that along the volume.
constexpr double kMostPieces = 128.0;

}  // namespace

VolumeSide VolumeSide::plane(const Vec3d& n, double offset) {
  const double norm = n == Vec3d() ? 1.0 : length(n);  // of an empty volume: all or nothing
  return {Shape::plane, {}, n / norm, offset / norm, 0.0};
}

VolumeSide VolumeSide::ball(const Vec3d& center, double radius) {
  return {Shape::ball, center, {}, radius, radius / kPerRadius};
}

VolumeSide VolumeSide::hole(const Vec3d& center, double radius) {
  return {Shape::hole, center, {}, radius, radius / kPerRadius};
}

VolumeSide VolumeSide::tube(const Vec3d& center, const Vec3d& axis, double radius) {
  return {Shape::tube, center, axis, radius, radius / kPerRadius};
}

VolumeSide VolumeSide::cone(const Vec3d& apex, const Vec3d& axis, double cosine, double reach) {
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return {Shape::cone, apex, axis, cosine,
          std::max(reach * sine / kPerRadius, reach / kMostPieces)};
}

double VolumeSide::depth(const Vec3d& p) const {
  const Vec3d w = p - center;
  switch (shape) {
    case Shape::plane:
      break;
    case Shape::ball:
      return size - length(w);
    case Shape::hole:
      return length(w) - size;
    case Shape::tube:
      return size - length(cross(w, n));
    case Shape::cone:
      return (dot(w, n) - size * length(w)) / (1.0 + size);
  }
  return size - dot(n, p);
}

void SideList::add(const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d n;
    n[axis] = 1.0;
    add_slab(n, box.lo[axis], box.hi[axis]);
  }
}

void SideList::add_slab(const Vec3d& n, double lo, double hi) {
  add(VolumeSide::plane(n, hi)), add(VolumeSide::plane(-n, -lo));
}

}  // namespace strahl
