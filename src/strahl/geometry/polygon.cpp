// geometry/polygon.cpp - projection, exact convexity test, fan and ear clipping.
//
// Ear clipping: [Meisters1975] two-ears theorem; whether a corner is an ear is kept per corner, as
//   cutting one off changes the answer for its two neighbours only. A corner is an ear when it
//   turns strictly left and no corner that does not lies in its closed triangle (corners at the
//   position of a or c are ignored, which is what makes bridges to holes work).
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <strahl/geometry/point_tree.h>
#include <strahl/geometry/polygon.h>
#include <strahl/math/orient2d.h>

namespace strahl {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

void fan(std::uint32_t corner_count, Triangles& triangles) {
  for (std::uint32_t i = 2; i < corner_count; ++i) triangles.push_back({0, i - 1, i});
}

/// Twice the vector area, measured from corner 0 so that a far-away polygon loses nothing.
Vec3d newell_normal(std::span<const Vec3d> corners) {
  Vec3d normal;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    normal = normal + cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
  }
  return normal;
}

/// Drops the coordinate of the largest normal component; the kept two stay in cyclic order.
std::vector<Point2> project(std::span<const Vec3d> corners, const Vec3d& normal) {
  const Vec3d size = abs(normal);
  const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  std::vector<Point2> points;
  points.reserve(corners.size());
  for (const Vec3d& corner : corners) points.push_back({corner[u], corner[v]});
  return points;
}

bool ascending(const Point2& a, const Point2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// True when the boundary turns one way only (or runs straight) and goes round once: then it
/// changes between ascending and descending (lexicographically) exactly twice. Repeated points are
/// passed over. A boundary without any turn is not convex.
bool is_convex(std::span<const Point2> points) {
  const std::size_t n = points.size();
  std::size_t start = 0;
  while (start < n && points[start] == points[(start + n - 1) % n]) ++start;
  if (start == n) return false;
  Point2 before = points[(start + n - 1) % n], here = points[start];
  int side = 0, reversals = 0;
  for (std::size_t step = 1; step <= n; ++step) {
    const Point2 next = points[(start + step) % n];
    if (next == here) continue;
    const int turn = orient2d(before, here, next);
    const bool reverses = ascending(before, here) != ascending(here, next);
    if (turn == 0 ? reverses : turn == -side) return false;
    if (turn != 0) side = turn;
    reversals += reverses ? 1 : 0;
    before = here, here = next;
  }
  return side != 0 && reversals == 2;
}

/// The polygon while ears are being cut off: a ring of the corners left, in left-turning order.
class EarClipper {
 public:
  explicit EarClipper(std::span<const Point2> points);
  void run(Triangles& triangles);

 private:
  enum class Turn : std::uint8_t { left, straight, right };

  void classify(std::uint32_t i);
  bool is_ear(std::uint32_t i) const;
  bool blocks(std::uint32_t corner, const Point2& a, const Point2& b, const Point2& c) const;
  bool in_angle(const Point2& p, const Point2& a, const Point2& b, const Point2& c) const;
  bool reaches_left_of(const Box2& box, const Point2& a, const Point2& b) const;
  std::uint32_t next_to_cut(std::uint32_t from) const;
  void remove(std::uint32_t i);

  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::span<const Point2> points_;
  int left_ = 1;  ///< the orientation of a left turn as seen along the polygon's own normal
  std::uint32_t corner_count_;
  std::vector<std::uint32_t> previous_, next_;
  std::vector<Turn> turns_;
  std::vector<std::uint8_t> ears_;
  PointTree blockers_;  ///< marks the corners that do not turn left
};

/// The side the whole boundary turns to: exact for simple polygons, whose lexicographically lowest
/// corner is a convex one. `fallback` where that corner is a spike or repeated.
int orientation(std::span<const Point2> points, int fallback) {
  const std::size_t n = points.size();
  const std::size_t lowest = static_cast<std::size_t>(
      std::min_element(points.begin(), points.end(), ascending) - points.begin());
  const int side = orient2d(points[(lowest + n - 1) % n], points[lowest], points[(lowest + 1) % n]);
  return side != 0 ? side : fallback;
}

/// Floating-point sign of the area, for polygons that orientation() cannot read.
int area_sign(std::span<const Point2> points) {
  double area = 0.0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Point2 &o = points[0], &a = points[i - 1], &b = points[i];
    area += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  }
  return area < 0.0 ? -1 : 1;
}

EarClipper::EarClipper(std::span<const Point2> points)
    : points_(points),
      left_(orientation(points, area_sign(points))),
      corner_count_(static_cast<std::uint32_t>(points.size())),
      previous_(points.size()),
      next_(points.size()),
      turns_(points.size(), Turn::left),
      ears_(points.size(), 0),
      blockers_(points) {
  const std::uint32_t n = corner_count_;
  for (std::uint32_t i = 0; i < n; ++i) {
    previous_[i] = (i + n - 1) % n;
    next_[i] = (i + 1) % n;
  }
  for (std::uint32_t i = 0; i < n; ++i) classify(i);
  for (std::uint32_t i = 0; i < n; ++i) ears_[i] = is_ear(i);
}

void EarClipper::classify(std::uint32_t i) {
  const int turn = left_ * orient2d(points_[previous_[i]], points_[i], points_[next_[i]]);
  turns_[i] = turn > 0 ? Turn::left : turn == 0 ? Turn::straight : Turn::right;
  blockers_.set_marked(i, turn <= 0);
}

/// True strictly inside the angle a, b, c.
bool EarClipper::in_angle(const Point2& p, const Point2& a, const Point2& b,
                          const Point2& c) const {
  return left_ * orient2d(a, b, p) > 0 && left_ * orient2d(b, c, p) > 0;
}

/// Does `corner` keep a, b, c from being an ear? A boundary that touches the tip b from inside does
/// when it comes out of the triangle; one that touches a or c would have to cross an edge to do so.
bool EarClipper::blocks(std::uint32_t corner, const Point2& a, const Point2& b,
                        const Point2& c) const {
  const Point2& p = points_[corner];
  if (p == a || p == c) return false;
  if (p == b) {
    return in_angle(points_[previous_[corner]], a, b, c) ||
           in_angle(points_[next_[corner]], a, b, c);
  }
  return left_ * orient2d(c, a, p) >= 0 && left_ * orient2d(a, b, p) >= 0 &&
         left_ * orient2d(b, c, p) >= 0;
}

/// False only if the whole box lies strictly to the right of a -> b: its leftmost corner does.
bool EarClipper::reaches_left_of(const Box2& box, const Point2& a, const Point2& b) const {
  const bool high_x = left_ > 0 ? b.y < a.y : b.y > a.y;
  const bool high_y = left_ > 0 ? b.x > a.x : b.x < a.x;
  const Point2 corner{high_x ? box.high.x : box.low.x, high_y ? box.high.y : box.low.y};
  return left_ * orient2d(a, b, corner) >= 0;
}

bool EarClipper::is_ear(std::uint32_t i) const {
  if (turns_[i] != Turn::left) return false;
  const Point2 &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
  const auto [x_low, x_high] = std::minmax({a.x, b.x, c.x});
  const auto [y_low, y_high] = std::minmax({a.y, b.y, c.y});
  const auto may_block = [&, x0 = x_low, x1 = x_high, y0 = y_low, y1 = y_high](const Box2& box) {
    return box.low.x <= x1 && box.high.x >= x0 && box.low.y <= y1 && box.high.y >= y0 &&
           reaches_left_of(box, a, b) && reaches_left_of(box, b, c) && reaches_left_of(box, c, a);
  };
  return !blockers_.any_marked(may_block, [&](std::uint32_t p) { return blocks(p, a, b, c); });
}

/// The first ear from `from` on. Polygons that cross or touch themselves may have none: then the
/// first straight corner, as its triangle has no area, then the first left turn, then any.
std::uint32_t EarClipper::next_to_cut(std::uint32_t from) const {
  std::uint32_t straight = kNone, left = kNone, i = from;
  do {
    if (ears_[i] != 0) return i;
    if (straight == kNone && turns_[i] == Turn::straight) straight = i;
    if (left == kNone && turns_[i] == Turn::left) left = i;
    i = next_[i];
  } while (i != from);
  return straight != kNone ? straight : left != kNone ? left : from;
}

void EarClipper::remove(std::uint32_t i) {
  const std::uint32_t before = previous_[i], after = next_[i];
  next_[before] = after, previous_[after] = before;
  blockers_.set_marked(i, false);
  classify(before), classify(after);
  ears_[before] = is_ear(before), ears_[after] = is_ear(after);
}

void EarClipper::run(Triangles& triangles) {
  std::uint32_t from = 0;
  for (std::uint32_t left = corner_count_; left > 3; --left) {
    const std::uint32_t tip = next_to_cut(from);
    triangles.push_back({previous_[tip], tip, next_[tip]});
    // Going on past the next corner spreads the cuts round the polygon: fewer slivers.
    from = next_[next_[tip]];
    remove(tip);
  }
  triangles.push_back({previous_[from], from, next_[from]});
}

}  // namespace

void triangulate_polygon(std::span<const Vec3d> corners, Triangles& triangles) {
  const auto n = static_cast<std::uint32_t>(corners.size());
  if (n < 3) return;
  const Vec3d normal = newell_normal(corners);
  const bool usable = is_finite(normal) && norm_max(normal) > 0.0;
  if (n == 3 || !usable) return fan(n, triangles);
  const std::vector<Point2> points = project(corners, normal);
  if (is_convex(points)) return fan(n, triangles);
  EarClipper(points).run(triangles);
}

}  // namespace strahl
