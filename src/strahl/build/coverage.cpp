#include <algorithm>
#include <utility>

#include <strahl/build/coverage.h>

namespace strahl {
namespace {

using Piece = std::vector<PlanarPoint>;

/// Twice the area of a, b, p, positive where p lies left of the line from a to b.
double side(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& p) {
  return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u);
}

double area_of(const Piece& piece) {
  double twice = 0.0;
  for (std::size_t i = 2; i < piece.size(); ++i) twice += side(piece[0], piece[i - 1], piece[i]);
  return twice / 2;
}

/// The part of a convex piece left of the line (sign 1) or right of it (sign -1).
Piece part_beside(const Piece& piece, const PlanarPoint& a, const PlanarPoint& b, double sign) {
  Piece part;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const PlanarPoint& p = piece[i];
    const PlanarPoint& q = piece[(i + 1) % piece.size()];
    const double from = sign * side(a, b, p), to = sign * side(a, b, q);
    if (from >= 0.0) part.push_back(p);
    if ((from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0)) {
      const double t = from / (from - to);
      part.push_back({p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)});
    }
  }
  return part;
}

bool lies_apart(const Piece& piece, const std::array<PlanarPoint, 3>& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto is_right = [&](const PlanarPoint& p) {
      return side(triangle[i], triangle[(i + 1) % 3], p) <= 0.0;
    };
    if (std::all_of(piece.begin(), piece.end(), is_right)) return true;
  }
  return false;
}

}  // namespace

OpenArea::OpenArea() : pieces_{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}} {}

void OpenArea::cover(std::array<PlanarPoint, 3> triangle) {
  // Pieces this small cannot add up to what counts.
  constexpr double kDust = kNegligible / (64 * kMostPieces);
  const double twice = side(triangle[0], triangle[1], triangle[2]);
  if (!(twice != 0.0)) return;
  if (twice < 0.0) std::swap(triangle[1], triangle[2]);
  std::vector<Piece> open;
  area_ = 0.0;
  const auto keep = [&](Piece piece) {
    const double area = area_of(piece);
    if (!(area > kDust)) return;
    area_ += area;
    open.push_back(std::move(piece));
  };
  for (Piece& piece : pieces_) {
    if (lies_apart(piece, triangle)) {
      keep(std::move(piece));
      continue;
    }
    for (std::size_t i = 0; i < 3 && !piece.empty(); ++i) {
      const PlanarPoint &a = triangle[i], &b = triangle[(i + 1) % 3];
      keep(part_beside(piece, a, b, -1.0));
      piece = part_beside(piece, a, b, 1.0);
    }
  }
  pieces_ = std::move(open);
}

}  // namespace strahl
