// structures/wide_bvh/wide_trace.h - one ray through a wide tree: sets the kernel up for the query
// and decides exactly what the kernel leaves open.
//
// Only a query whose every crossing within the interval counts (no mask, culling, exclusion or
// cursor) lets the kernel take certain lanes by itself; for the others each possible lane is
// resolved.
#pragma once

#include <bit>
#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include <strahl/geometry/triangle.h>
#include <strahl/query/counters.h>
#include <strahl/query/policies.h>
#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl {

/// Visitors that can make the hit of a reference known to be crossed.
template <class Prims, class Q>
concept MakesHits = requires(Prims& prims, std::uint32_t reference, const Q& query) {
  { prims.blank_hit(reference) } -> std::same_as<Hit>;
  { prims.sees_all(query) } -> std::same_as<bool>;
};

/// Corners of a lane as stored, promoted.
inline TriangleVertices stored_corners(const std::byte* leaf, std::uint32_t lanes,
                                       std::uint32_t lane) {
  if (is_compact(leaf)) return compact_corners(leaf, lanes, lane);
  double v[9];
  for (std::uint32_t row = 0; row < 9; ++row)
    v[row] = static_cast<double>(corner_row(leaf, lanes, row)[lane]);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
}

/// Compiles to nothing for NoCounters.
template <class C>
void add_counts(const WideCounts& counts, C& counters) {
  if constexpr (!std::is_same_v<C, NoCounters>) {
    for (std::uint64_t i = 0; i < counts.nodes; ++i) {
      counters.traversal_step();
    }
    for (std::uint64_t i = 0; i < counts.leaves; ++i) {
      counters.leaf_entered(false);
    }
    for (std::uint64_t i = 0; i < counts.lanes; ++i) {
      counters.primitive_tested();
    }
    counters.volume_tests(static_cast<int>(counts.boxes));
  }
}

template <class Prims, class Q, class C>
class WideTrace {
 public:
  WideTrace(const WideTree& tree, const WideKernel& kernel, Prims& prims, const Ray& ray,
            const RayFrame& frame, Q& query, C& counters)
      : WideTrace(tree, kernel, prims, ray,
                  frame.widen_absolute + frame.widen_per_org * norm_max(ray.org), &frame, query,
                  counters) {}
  /// @param ray of which `prepared` was made
  WideTrace(const WideTree& tree, const WideKernel& kernel, Prims& prims, const Ray& ray,
            const PreparedRay& prepared, Q& query, C& counters)
      : WideTrace(tree, kernel, prims, ray, norm_max(abs(prepared.near_org - prepared.org)),
                  nullptr, query, counters) {
    prepared_ = prepared;
  }
  WideTrace(const WideTrace&) = delete;
  WideTrace& operator=(const WideTrace&) = delete;

  void run() {
    WideRays rays;
    WideAnswers answers;
    wide_.put(rays, 0);
    answers.candidate[0] = 0;
    take_bounds(answers);
    WideJob job{tree_, rays, answers, this, &resolve};
    kernel_.find(mode(), kIsCounted, tree_.width)(job, 1);
    if (answers.is_found(0)) accept_any();
    settle(answers);
    add_counts(job.counts, counters_);
  }

 private:
  static constexpr bool kIsCounted = !std::is_same_v<C, NoCounters>;
  static constexpr bool kMakesHits = MakesHits<Prims, Q>;

  WideTrace(const WideTree& tree, const WideKernel& kernel, Prims& prims, const Ray& ray,
            double widening, const RayFrame* frame, Q& query, C& counters)
      : tree_(tree),
        kernel_(kernel),
        prims_(prims),
        ray_(ray),
        frame_(frame),
        query_(query),
        counters_(counters),
        wide_(ray, widening, tree.frame) {}

  WideMode mode() const {
    if constexpr (kMakesHits && std::is_same_v<Q, ClosestHit>)
      if (prims_.sees_all(query_)) return WideMode::closest;
    if constexpr (kMakesHits && std::is_same_v<Q, AnyHit>)
      if (prims_.sees_all(query_)) return WideMode::any;
    return WideMode::each;
  }

  /// Of the only ray.
  void take_bounds(WideAnswers& answers) const {
    const double t = query_.t_max();
    if (t == std::numeric_limits<double>::infinity()) {
      answers.upper[0] = answers.lower[0] = kWideMostT;
      return;
    }
    answers.upper[0] = wide_.upper(t), answers.lower[0] = wide_.lower(t);
  }

  void accept_any() {
    if constexpr (std::is_same_v<Q, AnyHit>) query_.found = true;
  }

  static bool resolve(WideJob& job, std::uint32_t, WideId leaf, std::uint32_t lanes) {
    auto& self = *static_cast<WideTrace*>(job.context);
    self.settle(job.answers);
    const std::uint32_t* references = reference_row(self.tree_.at(leaf), lanes_of(leaf));
    NoCounters uncounted;  // the kernel has counted the lanes
    for (; lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t reference = references[std::countr_zero(lanes)];
      if (self.prims_.visit(reference, self.prepared(), self.query_, uncounted)) return true;
    }
    self.take_bounds(job.answers);
    return false;
  }

  /// Offers the candidate with its canonical t.
  void settle(WideAnswers& answers) {
    const WideId candidate = std::exchange(answers.candidate[0], 0u);
    if (candidate == 0) return;
    const std::byte* leaf = tree_.at(candidate);
    const std::uint32_t lanes = lanes_of(candidate), lane = answers.lane[0];
    const std::uint32_t reference = reference_row(leaf, lanes)[lane];
    if constexpr (kMakesHits && std::is_same_v<Q, ClosestHit>) {
      if (tree_.is_exact(leaf)) {
        const TriangleVertices triangle = stored_corners(leaf, lanes, lane);
        const std::optional<double> t =
            crossing_t(ray_.org, ray_.dir, triangle, triangle.a - ray_.org);
        take(prims_.blank_hit(reference), *t + 0.0, answers.is_front(0));
        return;
      }
    }
    NoCounters uncounted;
    prims_.visit(reference, prepared(), query_, uncounted);
  }

  /// For closest hits: one that is known to be the first so far.
  void take(const Hit& blank, double t, bool is_front) {
    Hit& best = query_.best;
    best.id = blank.id, best.reference = blank.reference;
    best.t = t, best.is_front = is_front;
  }

  const PreparedRay& prepared() {
    if (!prepared_) prepared_.emplace(ray_, *frame_);
    return *prepared_;
  }

  const WideTree& tree_;
  const WideKernel& kernel_;
  Prims& prims_;
  const Ray& ray_;
  const RayFrame* frame_;
  Q& query_;
  C& counters_;
  WideRay wide_;
  std::optional<PreparedRay> prepared_;
};

}  // namespace strahl
