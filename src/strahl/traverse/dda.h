// traverse/dda.h - the one loop over all grids: every cell a ray may touch, once, front to back.
//
// Source: [AmanatidesWoo1987], with the parameter of each plane computed anew instead of summed up.
// Which cells: a cell is crossed on axis a while t lies in [enter, leave], enter the parameter of
//   its near plane for the origin shifted against the ray (PreparedRay::plane_first), lowered by
//   kPlaneMargin, leave that of its far plane (plane_last), raised by it. The true parameter of any
//   point of the closed cell, and of anything that the scene's widening moves it to, lies in the
//   three intervals. dda() visits exactly the cells whose three intervals and
//   [ray.t_enter, ray.t_exit] have a common parameter, so no hit is lost.
// How: neighbouring slabs of an axis overlap by the width of their plane's margin: a slab is
//   entered before its predecessor is left. The loop sweeps t over the "enter" events of all axes
//   and keeps per axis the slabs that are entered and not left, oldest..newest. At an event it
//   visits the new slab's cells in the product of the other axes' slabs: those are the cells whose
//   latest enter is this event. Almost always each axis has one slab, and a step is that of the
//   paper. Near an edge or corner of cells two or three axes have two slabs each: all cells around
//   it are visited. A ray inside a plane (direction 0, parameters NaN or infinite) has two slabs
//   from beginning to end. Far origins and wide margins make the ranges long, in the limit the
//   whole grid; nothing else changes. Comparisons are written so that NaN means "may".
// Jumps: an action that knows the cells around one to be empty returns how far (CellJump). A jump
//   changes what the sweep's state says - which slabs are open and when the next one is entered -
//   to what steps would have made of it just before a later t: the slabs are found anew by the same
//   comparisons of the same parameters, and what is entered at t itself is still to come, so ties,
//   NaN, margins and the end of the traversal are those of steps. What must be shown is only that
//   every cell in between is a known one. Numbers of slabs passed since the known cell bound the
//   positions of these cells, and each known region holds, with a position, all positions nearer on
//   every axis, so the last position decides. A guess of where the region ends is checked against
//   it; a wrong one costs a step, nothing else. Regions that reach forward only, or that are
//   rounded at their corners, are used where no slab that lies behind stays open until the next one
//   is entered.
// Invariants: enter and leave grow with the slab (planes are monotone and so is rounding), and
//   leave of a slab is not before enter of the next, so oldest..newest is never empty.
// Thread safety: pure; needs round-to-nearest.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <strahl/math/ray.h>
#include <strahl/math/uniform_cells.h>
#include <strahl/traverse/cell_jump.h>

namespace strahl {

/// State of a sweep; use dda().
template <class Cells>
class CellSweep {
 public:
  CellSweep(const Cells& cells, const PreparedRay& ray) : cells_(cells), ray_(ray) {
    t_begin_ = ray.t_enter, t_end_ = ray.t_exit;
    for (int a = 0; a < 3; ++a) {
      Slabs& s = axis(a);
      const int last = cells.n(a) - 1;
      s.near_org = ray.near_org[a], s.far_org = ray.far_org[a];
      s.inv_early = ray.inv_dir[a] * (1.0 - kPlaneMargin);
      s.inv_late = ray.inv_dir[a] * (1.0 + kPlaneMargin);
      s.step = ray.negative[a] ? -1 : 1, s.is_down = ray.negative[a];
      s.first = s.is_down ? last : 0, s.last = s.is_down ? 0 : last;
      const double enter = enters(a, s.first), leave = leaves(a, s.last);
      t_begin_ = enter > t_begin_ ? enter : t_begin_;
      t_end_ = leave < t_end_ ? leave : t_end_;
    }
  }

  template <class Action>
  bool run(Action& action) {
    if (!(t_begin_ <= t_end_)) return false;
    for (int a = 0; a < 3; ++a) open_first(a);
    auto jump = visit(kNoAxis, t_begin_, action);
    note_alone();
    while (distance_of(jump) != kStopCells) {
      if (distance_of(jump) > 1 && !leap(jump)) return false;
      const int a = next_axis();
      const double t = axis(a).t_next;
      if (!(t <= t_end_)) return false;
      if (t_alone_ < t) {
        for (Slabs& s : axis_) s.oldest = s.newest;
        enter_slab(a);
        t_alone_ = axis(a).t_left;
        jump = visit_newest(t, action);
      } else {
        for (int b = 0; b < 3; ++b) leave_slabs(b, t);
        enter_slab(a);
        jump = visit(a, t, action);
        note_alone();
      }
    }
    return true;
  }

 private:
  /// A number is short for a jump by the chessboard metric.
  template <class Action>
  using JumpOf =
      std::conditional_t<std::is_same_v<std::invoke_result_t<Action&, const CellVisit&>, CellJump>,
                         CellJump, int>;
  static int distance_of(int jump) { return jump; }
  static int distance_of(const CellJump& jump) { return jump.distance; }

  static constexpr int kNoAxis = 3;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// One axis. Cells are numbered as in the grid and ordered as the ray meets them.
  struct Slabs {
    double near_org, far_org;
    double inv_early, inv_late;  ///< 1 / direction with the margin in it
    double t_next;               ///< when newest + step is entered; infinite beyond the last
    double t_left;               ///< when newest - step is left; valid while oldest != newest
    int step, first, last;
    int oldest, newest;
    bool is_down;
    bool is_single() const { return oldest == newest; }
  };

  Slabs& axis(int a) { return axis_[static_cast<std::size_t>(a)]; }
  const Slabs& axis(int a) const { return axis_[static_cast<std::size_t>(a)]; }

  // The margin brings a negative parameter to the wrong side, but it stays negative, and the sweep
  // begins at 0 or later.
  double enters(int a, int cell) const {
    const Slabs& s = axis(a);
    return (cells_.plane(a, cell + s.is_down) - s.near_org) * s.inv_early;
  }
  double leaves(int a, int cell) const {
    const Slabs& s = axis(a);
    return (cells_.plane(a, cell + !s.is_down) - s.far_org) * s.inv_late;
  }

  int next_axis() const {
    const int a = axis_[1].t_next < axis_[0].t_next ? 1 : 0;
    return axis_[2].t_next < axis(a).t_next ? 2 : a;
  }

  void enter_slab(int a) {
    Slabs& s = axis(a);
    s.newest += s.step;
    note_planes(a);
  }
  /// Parameters of the planes behind and before the newest slab.
  void note_planes(int a) {
    Slabs& s = axis(a);
    s.t_left = leaves(a, s.newest - s.step);
    s.t_next = s.newest == s.last ? kInfinity : enters(a, s.newest + s.step);
  }
  /// When every axis has one slab, unless more are entered before.
  void note_alone() {
    t_alone_ = -kInfinity;
    for (const Slabs& s : axis_)
      if (!s.is_single()) t_alone_ = s.t_left <= t_alone_ ? t_alone_ : never_if_nan(s.t_left);
  }
  static double never_if_nan(double t) { return t == t ? t : kInfinity; }
  /// Forgets the slabs that are left before t.
  void leave_slabs(int a, double t) {
    Slabs& s = axis(a);
    if (s.is_single()) return;
    if (s.t_left < t)
      s.oldest = s.newest;
    else
      while (leaves(a, s.oldest) < t) s.oldest += s.step;
  }
  void open_first(int a) {
    const Slabs& s = axis(a);
    int newest = newest_before(a, t_begin_, s.first, s.last);
    while (newest != s.last && !(enters(a, newest + s.step) > t_begin_)) newest += s.step;
    open_slabs(a, t_begin_, newest);
  }
  /// The newest slab among from..to that is entered before t, or `from`. The guess is off by about
  /// as many slabs as are open at once.
  int newest_before(int a, double t, int from, int to) const {
    const int step = axis(a).step;
    const auto [low, high] = std::minmax(from, to);
    int cell = std::clamp(cells_.guess(a, ray_.org[a] + t * ray_.dir[a]), low, high);
    while (cell != from && enters(a, cell) >= t) cell -= step;
    while (cell != to && !(enters(a, cell + step) >= t)) cell += step;
    return cell;
  }
  /// Finds the slabs that are entered, up to `newest`, and not left at t.
  void open_slabs(int a, double t, int newest) {
    Slabs& s = axis(a);
    s.newest = s.oldest = newest;
    while (s.oldest != s.first && !(leaves(a, s.oldest - s.step) < t)) s.oldest -= s.step;
    note_planes(a);
  }

  /// Visits the open cells that lie in the newest slab of axis `fresh`, all if kNoAxis.
  /// Returns the jump allowed from here, 1 where several cells are open, or kStopCells.
  template <class Action>
  JumpOf<Action> visit(int fresh, double t, Action& action) {
    const bool is_one = (fresh == 0 || axis_[0].is_single()) &&
                        (fresh == 1 || axis_[1].is_single()) &&
                        (fresh == 2 || axis_[2].is_single());
    if (is_one) return visit_newest(t, action);
    return {visit_block(fresh, t, action) ? kStopCells : 1};
  }
  template <class Action>
  JumpOf<Action> visit_newest(double t, Action& action) const {
    const CellPosition at{axis_[0].newest, axis_[1].newest, axis_[2].newest};
    return action(CellVisit{at, cells_.index(at), t});
  }
  template <class Action>
  bool visit_block(int fresh, double t, Action& action) {
    CellPosition from;
    for (int a = 0; a < 3; ++a)
      from[static_cast<std::size_t>(a)] = a == fresh ? axis(a).newest : axis(a).oldest;
    for (int z = from[2];; z += axis_[2].step) {
      for (int y = from[1];; y += axis_[1].step) {
        for (int x = from[0];; x += axis_[0].step) {
          const CellPosition at{x, y, z};
          const JumpOf<Action> jump = action(CellVisit{at, cells_.index(at), t});
          if (distance_of(jump) == kStopCells) return true;
          if (x == axis_[0].newest) break;
        }
        if (y == axis_[1].newest) break;
      }
      if (z == axis_[2].newest) break;
    }
    return false;
  }

  /// Moves on to where the ray leaves the region of the jump, or about there. False when the rest
  /// of the grid holds nothing else.
  bool leap(const CellJump& jump) {
    if (jump.metric == CellMetric::chessboard) return leave_box(jump);
    const double t_step = axis(next_axis()).t_next;
    if (!(t_alone_ < t_step)) return true;
    if (jump.metric == CellMetric::octant) return leave_box(jump);
    glide(jump, t_step);
    return true;
  }
  bool leap(int jump) { return leave_box({jump}); }

  static bool is_in_layer(const CellJump& jump, int a) { return (jump.layers >> a & 1) != 0; }

  /// Exactly to where the ray leaves a box of cells. Open slabs behind must be in it.
  bool leave_box(const CellJump& jump) {
    std::array<int, 3> reach;
    double t_out = kInfinity;
    for (int a = 0; a < 3; ++a) {
      const Slabs& s = axis(a);
      const int known = is_in_layer(jump, a) ? 1 : jump.distance,
                left = (s.last - s.newest) * s.step;
      if ((s.newest - s.oldest) * s.step >= known) return true;
      reach[static_cast<std::size_t>(a)] = std::min(known - 1, left);
      if (left >= known) t_out = std::min(t_out, enters(a, s.newest + known * s.step));
    }
    if (!(t_out <= t_end_)) return false;
    for (int a = 0; a < 3; ++a) {
      const Slabs& s = axis(a);
      const int farthest = s.newest + reach[static_cast<std::size_t>(a)] * s.step;
      open_slabs(a, t_out, newest_before(a, t_out, s.newest, farthest));
    }
    note_alone();
    return true;
  }

  /// About to where the ray leaves a region that is no box. All cells until then are in it if the
  /// last one is.
  void glide(const CellJump& jump, double t_step) {
    // In this order NaN stays NaN.
    double t = std::min(t_step + guess_way(jump, t_step), t_end_);
    for (int a = 0; a < 3; ++a)
      if (is_in_layer(jump, a)) t = std::min(t, axis(a).t_next);
    if (!(t > t_step)) return;
    CellPosition newest;
    std::int64_t distance = 0;
    for (int a = 0; a < 3; ++a) {
      const Slabs& s = axis(a);
      const int cell = newest_before(a, t, s.newest, is_in_layer(jump, a) ? s.newest : s.last);
      const std::int64_t passed = std::abs(cell - s.newest);
      distance += jump.metric == CellMetric::euclid ? passed * passed : passed;
      newest[static_cast<std::size_t>(a)] = cell;
    }
    if (distance >= jump.distance) return;
    for (int a = 0; a < 3; ++a) open_slabs(a, t, newest[static_cast<std::size_t>(a)]);
    note_alone();
  }

  /// How far beyond t_step the region reaches: after x more, at most rate * x + begun slabs of an
  /// axis are passed; their sum, or that of their squares, shall be below jump.distance.
  double guess_way(const CellJump& jump, double t_step) const {
    Vec3d rate, begun;
    for (int a = 0; a < 3; ++a) {
      if (is_in_layer(jump, a) || !(axis(a).t_next < kInfinity)) continue;
      rate[a] = std::abs(ray_.dir[a]) / (cells_.plane(a, 1) - cells_.plane(a, 0));
      begun[a] = 1.0 - (axis(a).t_next - t_step) * rate[a];
    }
    const double most = jump.distance - 1.0;
    if (jump.metric == CellMetric::city_block)
      return (most - (begun.x + begun.y + begun.z)) / (rate.x + rate.y + rate.z);
    const double rr = dot(rate, rate), rb = dot(rate, begun);
    return (std::sqrt(rb * rb + rr * (most - dot(begun, begun))) - rb) / rr;
  }

  const Cells& cells_;
  const PreparedRay& ray_;
  double t_begin_, t_end_;
  double t_alone_;  ///< see note_alone()
  std::array<Slabs, 3> axis_;
};

/// Calls action(const CellVisit&) for every cell that a point of the ray may lie in, each
/// once, by ascending t_enter. The action returns kStopCells to end the traversal, else a jump, as
/// a CellJump or as its distance by the chessboard metric: 1 for the next cell; d > 1 if all cells
/// less than d away need no visit (it is followed where just one cell is open, else taken for 1).
/// @param cells has n(axis), plane(axis, i) monotone in i, guess(axis, x), index(position)
/// @return whether the action stopped it. O(cells visited).
template <class Cells, class Action>
bool dda(const Cells& cells, const PreparedRay& ray, Action&& action) {
  return CellSweep<Cells>(cells, ray).run(action);
}

}  // namespace strahl
