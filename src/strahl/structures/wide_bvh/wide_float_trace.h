// structures/wide_bvh/wide_float_trace.h - the same as wide_trace.h for what most batches hold:
// float rays without filters, for the first or any hit in a tree that keeps the scene's
// coordinates.
//
// The ray is prepared in floats, and doubles are made only for the t of the hit and for what the
// kernel cannot decide, so that a ray costs little more than its traversal.
#pragma once

#include <optional>

#include <strahl/structures/wide_bvh/wide_trace.h>

namespace strahl {

/// Q is ClosestHit or AnyHit, of a visitor that sees all.
template <class Prims, class Q, class C>
class WideFloatTrace {
 public:
  WideFloatTrace(const WideTree& tree, const WideKernel& kernel, Prims& prims, C& counters)
      : tree_(tree),
        prims_(prims),
        counters_(counters),
        traverse_(kernel.find(kIsAny ? WideMode::any : WideMode::closest, kIsCounted, tree.width)) {
  }
  WideFloatTrace(const WideFloatTrace&) = delete;
  WideFloatTrace& operator=(const WideFloatTrace&) = delete;

  /// The first hit, or whether there is any; false, and no answer, for a ray that needs doubles.
  /// @param answer a miss, as made by its default
  template <class Answer>
  bool run(const Vec3f& org, const Vec3f& dir, float t_min, float t_max, Answer& answer) {
    WideRay wide;
    if (!wide.set_floats(org, dir, t_min, t_max, tree_.frame)) return false;
    org_ = org, dir_ = dir, t_min_ = t_min, t_max_ = t_max, wide_ = &wide;
    WideState state;
    state.context = this, state.resolve = &resolve;
    const float last = t_max < kWideMostT ? t_max : kWideMostT / 2;
    state.upper = float_a_little_above(last), state.lower = float_a_little_below(last);
    traverse_(tree_, wide, state);
    finish(state, answer);
    add_counts(state.counts, counters_);
    slow_.reset();
    return true;
  }

 private:
  static constexpr bool kIsAny = std::is_same_v<Q, AnyHit>;
  static constexpr bool kIsCounted = !std::is_same_v<C, NoCounters>;

  /// What is needed once a lane must be decided exactly.
  struct Slow {
    Ray ray;
    PreparedRay prepared;
    Q query;
    Slow(const Ray& r, const RayFrame& frame) : ray(r), prepared(r, frame), query(r, HitFilter{}) {}
  };

  void finish(WideState& state, std::uint8_t& answer) {
    answer = state.is_found || (slow_ && slow_->query.found);
  }
  void finish(WideState& state, Hit& answer) {
    if (state.candidate != 0)
      settle(state, answer);
    else if (slow_)
      answer = slow_->query.best;
  }

  static bool resolve(WideState& state, WideId leaf, std::uint32_t lanes) {
    auto& self = *static_cast<WideFloatTrace*>(state.context);
    if (!self.slow_)
      self.slow_.emplace(
          Ray{Vec3d(self.org_), Vec3d(self.dir_), double{self.t_min_}, double{self.t_max_}},
          self.prims_.scene().world_frame());
    return self.decide(state, leaf, lanes);
  }

  bool decide(WideState& state, WideId leaf, std::uint32_t lanes) {
    if constexpr (!kIsAny)
      if (state.candidate != 0) settle(state, slow_->query.best);
    const std::uint32_t* references = reference_row(tree_.at(leaf), lanes_of(leaf));
    NoCounters uncounted;  // the kernel has counted the lanes
    for (; lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t reference = references[std::countr_zero(lanes)];
      if (prims_.visit(reference, slow_->prepared, slow_->query, uncounted)) return true;
    }
    if (slow_->query.t_max() < Aabb::kInf) {
      state.upper = wide_->upper(slow_->query.t_max());
      state.lower = wide_->lower(slow_->query.t_max());
    }
    return false;
  }

  /// The candidate with its canonical t.
  void settle(WideState& state, Hit& hit) const {
    const std::byte* leaf = tree_.at(state.candidate);
    const std::uint32_t lanes = lanes_of(state.candidate), lane = state.candidate_lane;
    state.candidate = 0;
    const std::uint32_t reference = reference_row(leaf, lanes)[lane];
    const Vec3d org(org_), dir(dir_);
    TriangleVertices triangle;
    if (tree_.has_exact_corners)
      triangle = stored_corners(leaf, lanes, lane);
    else
      prims_.scene().triangle(reference, triangle);
    hit.id = prims_.blank_hit(reference).id;
    hit.is_front = state.candidate_is_front, hit.reference = reference;
    hit.t = *crossing_t(org, dir, triangle, triangle.a - org) + 0.0;
  }

  const WideTree& tree_;
  Prims& prims_;
  C& counters_;
  WideTraverse traverse_;
  Vec3f org_, dir_;
  float t_min_ = 0, t_max_ = 0;
  const WideRay* wide_ = nullptr;
  std::optional<Slow> slow_;
};

}  // namespace strahl
