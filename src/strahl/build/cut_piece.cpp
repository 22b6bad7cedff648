#include <algorithm>
#include <cmath>
#include <utility>

#include <strahl/build/cut_piece.h>

namespace strahl {
namespace {

double polygon_area(const std::vector<Vec3d>& corners) {
  Vec3d doubled;
  for (std::size_t i = 2; i < corners.size(); ++i)
    doubled = doubled + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  return 0.5 * length(doubled);
}

}  // namespace

double PlacedVolume::depth(const VolumeSide& side, const Vec3d& p) const {
  if (placement == nullptr) return side.depth(p);
  constexpr double kRounding = 0x1p-44;
  const Affine& map = placement->to_object;
  const Vec3d shift = abs(Vec3d{map.m[0][3], map.m[1][3], map.m[2][3]});
  const double size = 3.0 * placement->stretch * norm_max(p) + norm_max(shift);
  return (side.depth(map.point(p)) + kRounding * size) / placement->stretch;
}

/// Cuts polygons along one side of a volume.
class CutPiece::Knife {
 public:
  Knife(const PlacedVolume& volume, const VolumeSide& side, std::vector<Flat>& out)
      : volume_(volume), side_(side), fine_(volume.in_world(side.fine)), out_(out) {
    if (volume.extent < Aabb::kInf)
      fine_ = std::max(fine_, volume.in_world(kLeastPart * volume.extent));
  }

  void cut(Flat polygon) {
    bool any_in = false, any_out = false;
    depths_.clear();
    for (const Vec3d& p : polygon.corners) {
      depths_.push_back(volume_.depth(side_, p));
      (depths_.back() < 0.0 ? any_out : any_in) = true;
    }
    const bool is_plane = side_.shape == VolumeSide::Shape::plane;
    if (!any_out && side_.is_convex()) return out_.push_back(std::move(polygon));
    if (!any_in && is_plane) return;
    if (is_plane) return keep_inside(polygon);
    cut_round(std::move(polygon));
  }

 private:
  /// What is smaller against its volume is not divided.
  static constexpr double kLeastPart = 0x1p-8;

  void cut_round(Flat polygon) {
    const Aabb box = box_of(polygon.corners);
    const double reach = 0.5 * length(box.extent()), depth = volume_.depth(side_, box.center());
    if (depth < -reach) return;
    if (depth >= reach) return out_.push_back(std::move(polygon));
    if (reach <= fine_) return keep_inside(polygon);
    const int axis = box.longest_axis();
    const double middle = box.center()[axis];
    for (const double sign : {1.0, -1.0}) {
      depths_.clear();
      for (const Vec3d& p : polygon.corners) depths_.push_back(sign * (p[axis] - middle));
      std::vector<Vec3d> half = inside(polygon.corners);
      if (half.size() > 2) cut({std::move(half), polygon.weight});
    }
  }

  void keep_inside(const Flat& polygon) {
    std::vector<Vec3d> kept = inside(polygon.corners);
    if (kept.size() > 2) out_.push_back({std::move(kept), polygon.weight});
  }

  /// What lies where the depths of the corners, taken to be linear between them, are positive.
  std::vector<Vec3d> inside(const std::vector<Vec3d>& corners) const {
    std::vector<Vec3d> kept;
    kept.reserve(corners.size() + 1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::size_t next = (i + 1) % corners.size();
      const double here = depths_[i], there = depths_[next];
      if (!(here < 0.0)) kept.push_back(corners[i]);
      if ((here < 0.0) == (there < 0.0)) continue;
      kept.push_back(corners[i] + (here / (here - there)) * (corners[next] - corners[i]));
    }
    return kept;
  }

  static Aabb box_of(const std::vector<Vec3d>& points) {
    Aabb box;
    for (const Vec3d& p : points) box.extend(p);
    return box;
  }

  const PlacedVolume& volume_;
  const VolumeSide& side_;
  double fine_;
  std::vector<Flat>& out_;
  std::vector<double> depths_;  ///< of the corners of the polygon at hand
};

void CutPiece::cut_to(const PlacedVolume& volume) {
  cut_patches(volume);
  std::vector<Flat> kept;
  for (const VolumeSide& side : volume.sides) {
    kept.clear();
    Knife knife(volume, side, kept);
    for (Flat& polygon : flat_) knife.cut(std::move(polygon));
    flat_.swap(kept);
  }
}

void CutPiece::cut_patches(const PlacedVolume& volume) {
  if (patches_.empty()) return;
  const double fine = surface_->fine_reach(volume.in_world(volume.extent));
  std::vector<Patch> waiting = std::exchange(patches_, {});
  while (!waiting.empty()) {
    const Patch patch = waiting.back();
    waiting.pop_back();
    const double reach = surface_->reach(patch);
    double depth = Aabb::kInf;
    for (const VolumeSide& side : volume.sides)
      depth = std::min(depth, volume.depth(side, surface_->middle(patch)));
    if (depth < -reach) continue;
    if (depth >= reach) {
      patches_.push_back(patch);
    } else if (reach > fine) {
      for (const Patch& half : surface_->halves(patch)) waiting.push_back(half);
    } else {
      flatten(patch);
    }
  }
}

void CutPiece::flatten(const Patch& patch) {
  const auto triangles = surface_->flattened(patch);
  double flat = 0.0;
  for (const TriangleVertices& t : triangles) flat += polygon_area({t.a, t.b, t.c});
  if (!(flat > 0.0)) return;
  const double weight = surface_->area(patch) / flat;
  for (const TriangleVertices& t : triangles) flat_.push_back({{t.a, t.b, t.c}, weight});
}

double CutPiece::area() const {
  double sum = 0.0;
  for (const Patch& patch : patches_) sum += surface_->area(patch);
  for (const Flat& polygon : flat_) sum += polygon.weight * polygon_area(polygon.corners);
  return sum;
}

}  // namespace strahl
