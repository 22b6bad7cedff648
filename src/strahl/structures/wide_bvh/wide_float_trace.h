// structures/wide_bvh/wide_float_trace.h - the same as wide_trace.h for what most batches hold:
// float rays without filters, for the first or any hit in a tree that keeps the scene's
// coordinates.
//
// Rays are made ready by vectors, a block at a time, and doubles are made only for the t of the
// hits and for what the kernel cannot decide, so that a ray costs little more than its traversal.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <strahl/query/reference_test.h>
#include <strahl/structures/wide_bvh/wide_ids.h>
#include <strahl/structures/wide_bvh/wide_trace.h>

namespace strahl {

/// Q is ClosestHit or AnyHit, of a visitor that sees all.
template <class Prims, class Q, class C>
class WideFloatTrace {
 public:
  using Answer = std::conditional_t<std::is_same_v<Q, AnyHit>, std::uint8_t, Hit>;
  static constexpr std::size_t kBlock = kWideBlock;  ///< most rays at a time

  /// @param batch how the rays of a block are traced where the kernel leaves a choice
  WideFloatTrace(const WideTree& tree, const WideKernel& kernel, WideBatch batch, Prims& prims,
                 const FloatRays& given, C& counters)
      : tree_(tree),
        kernel_(kernel),
        prims_(prims),
        ids_(prims.scene()),
        given_(given),
        counters_(counters),
        traverse_(kernel.find(kMode, kIsCounted, tree.width)) {
    const WideTraverse fly = kernel.fly[static_cast<std::size_t>(kMode)][tree.width == 16];
    if (kIsCounted || fly == nullptr || batch == WideBatch::single) return;
    traverse_ = fly;
    room_ = std::make_unique_for_overwrite<float[]>(2 * kWideBlock *
                                                    wide_stack_room(tree.width, tree.depth));
  }
  WideFloatTrace(const WideFloatTrace&) = delete;
  WideFloatTrace& operator=(const WideFloatTrace&) = delete;

  /// The first hits of rays first .. first + count - 1, or whether they have any.
  /// @return bits of those that need doubles or are invalid: they are given as misses
  std::uint64_t run(std::size_t first, std::uint32_t count, Answer* answers) {
    first_ = first, answers_ = answers, decided_ = 0;
    const auto reach = static_cast<float>(tree_.frame.reach);
    const std::uint64_t suited = kernel_.prepare(rays_, given_, first, count, reach);
    prefetch(first + count);
    known_.begin(rays_.upper, rays_.lower);
    WideJob job{tree_, rays_, known_, this, &resolve, {}, room_.get()};
    traverse_(job, suited);
    finish(count);
    add_counts(job.counts, counters_);
    return ~suited & all_of(count);
  }

 private:
  static constexpr bool kIsAny = std::is_same_v<Q, AnyHit>;
  static constexpr WideMode kMode = kIsAny ? WideMode::any : WideMode::closest;
  static constexpr bool kIsCounted = !std::is_same_v<C, NoCounters>;
  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr Vec3d kNoCorner = Vec3d::all(std::numeric_limits<double>::quiet_NaN());

  /// What the block that begins there reads first and writes, while the last one is traced. Of
  /// records of a ray all lines are asked for.
  void prefetch(std::size_t next) const {
    const std::byte* org = given_.orgs().data + next * given_.orgs().stride;
    const std::size_t bytes = kWideBlock * given_.orgs().stride;
    const std::size_t step = std::max<std::size_t>(64, given_.orgs().stride);
    for (std::size_t i = 0; i < bytes; i += step) __builtin_prefetch(org + i);
    const auto* written = reinterpret_cast<const std::byte*>(answers_ + (next - first_));
    for (std::size_t i = 0; i < sizeof(Answer) * kWideBlock; i += 64)
      __builtin_prefetch(written + i, 1);
  }

  /// Answers not written yet.
  void finish(std::uint32_t count) {
    if constexpr (kIsAny) {
      const std::uint64_t found = known_.found | decided_;
      std::uint32_t i = 0;
      for (; i + 8 <= count; i += 8) put_bits(found >> i, answers_ + i);
      for (; i < count; ++i) answers_[i] = std::uint8_t{(found >> i & 1u) != 0};
    } else {
      std::uint64_t missed = ~(settle_all() | decided_) & all_of(count);
      for (; missed != 0; missed &= missed - 1) answers_[std::countr_zero(missed)] = Hit{};
    }
  }
  /// The lowest eight as bytes: copied to each, the byte's own bit kept there, moved to its end.
  /// Little-endian, as all of it is (base/hash.h).
  static void put_bits(std::uint64_t bits, std::uint8_t* bytes) {
    constexpr std::uint64_t kEach = 0x0101010101010101u;
    const std::uint64_t own = (bits & 0xffu) * kEach & 0x8040201008040201u;
    const std::uint64_t ends = (own + 0x7f * kEach) >> 7 & kEach;
    std::memcpy(bytes, &ends, sizeof ends);
  }
  static std::uint64_t all_of(std::uint32_t count) {
    return ~std::uint64_t{0} >> (kWideBlock - count);
  }

  /// @return bits of rays that had candidates
  std::uint64_t settle_all() {
    alignas(64) double t[kWideBlock];
    WideSettled settled = kernel_.settle(tree_, rays_, known_, t);
    const bool has_all = tree_.has_exact_corners && tree_.layout == WideLayout::full;
    if (!has_all && settled.left != 0) settle_from_scene(settled, t);
    for (std::uint64_t rest = settled.certain; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
      take_candidate(i, t[i]);
    }
    for (std::uint64_t rest = settled.left; rest != 0; rest &= rest - 1)
      settle(static_cast<std::uint32_t>(std::countr_zero(rest)));
    return settled.certain | settled.left;
  }

  /// The canonical t of candidates left whose corners are the scene's only.
  void settle_from_scene(WideSettled& settled, double* t) {
    std::array<std::uint32_t, kWideBlock> references;
    std::array<TriangleVertices, kWideBlock> triangles;
    std::size_t count = 0;
    for (std::uint64_t rest = settled.left; rest != 0; rest &= rest - 1)
      references[count++] = known_.reference[std::countr_zero(rest)];
    const std::span left = std::span(references).first(count);
    prims_.scene().ask_for_triangles(left);
    prims_.scene().triangles(left, triangles.data());
    WideCorners corners;
    alignas(64) double found[kWideBlock];  // what is not left is written, too
    const TriangleVertices* triangle = triangles.data();
    for (std::uint64_t rest = settled.left; rest != 0; rest &= rest - 1)
      corners.put(static_cast<std::uint32_t>(std::countr_zero(rest)), *triangle++);
    const std::uint64_t certain = kernel_.settle_given(rays_, corners, settled.left, found);
    settled.certain |= certain, settled.left &= ~certain;
    for (std::uint64_t rest = certain; rest != 0; rest &= rest - 1) {
      const auto i = std::countr_zero(rest);
      t[i] = found[i];
    }
  }

  static bool resolve(WideJob& job, std::uint32_t ray, WideId leaf, std::uint32_t lanes) {
    return static_cast<WideFloatTrace*>(job.context)->decide(ray, leaf, lanes);
  }

  bool decide(std::uint32_t i, WideId leaf, std::uint32_t lanes) {
    if constexpr (!kIsAny)
      if (known_.candidate[i] != 0) settle(i), decided_ |= std::uint64_t{1} << i;
    const Ray ray = given_ray(i);
    Q query(ray, HitFilter{});
    if constexpr (!kIsAny)
      if (is_decided(i)) query.best = answers_[i];
    offer(i, ray, leaf, lanes, query);
    if constexpr (kIsAny) {
      decided_ |= std::uint64_t{query.found} << i;
      return query.found;
    } else {
      answers_[i] = query.best, decided_ |= std::uint64_t{1} << i;
      narrow(i, query.best.t * double{rays_.per_t[i]});
      return false;
    }
  }

  /// The exact test of lanes; of triangles with the corners of the block where they are the
  /// scene's, as they are at hand. One by one as long as their edge values are certain: mostly they
  /// all are.
  void offer(std::uint32_t i, const Ray& ray, WideId leaf, std::uint32_t lanes, Q& query) {
    const ExactRay exact(ray.org, ray.dir, prims_.scene().world_frame().bounds);
    const std::uint32_t* references = reference_row(tree_.at(leaf), lanes_of(leaf));
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      const TriangleVertices triangle = corners(leaf, lane);
      if (std::isnan(triangle.a.x)) {
        if (visit(i, references[lane], query)) return;
        continue;
      }
      bool is_open = false;
      const auto crossing =
          intersect(exact, triangle, [&](const Vec3d&) -> std::optional<TriangleHit> {
            is_open = true;
            return std::nullopt;
          });
      if (is_open) return offer_open(i, exact, leaf, lanes, query);
      if (crossing && offer_hit(references[lane], *crossing, query)) return;
    }
  }

  /// The same all at once, of a block that holds the scene's corners: where one edge value is
  /// uncertain, those of the triangles around a vertex are.
  void offer_open(std::uint32_t i, const ExactRay& ray, WideId leaf, std::uint32_t lanes,
                  Q& query) {
    const WideDecision decision = kernel_.decide[tree_.width == 16](tree_, rays_, i, leaf, lanes);
    for (std::uint32_t rest = decision.crossed | decision.left; rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
      const bool is_left = (decision.left >> lane & 1u) != 0;
      const bool is_front = (decision.fronts >> lane & 1u) != 0;
      if (is_left ? offer_left(i, ray, leaf, lane, query)
                  : offer_crossed(ray, leaf, lane, is_front, query))
        return;
    }
  }
  bool offer_left(std::uint32_t i, const ExactRay& ray, WideId leaf, std::uint32_t lane, Q& query) {
    const std::uint32_t reference = reference_row(tree_.at(leaf), lanes_of(leaf))[lane];
    const TriangleVertices triangle = corners(leaf, lane);
    if (std::isnan(triangle.a.x)) return visit(i, reference, query);
    return offer_triangle(triangle, ray, prims_.blank_hit(reference), query);
  }
  bool offer_crossed(const ExactRay& ray, WideId leaf, std::uint32_t lane, bool is_front,
                     Q& query) {
    const TriangleVertices triangle = corners(leaf, lane);
    const auto t = crossing_t(ray.org, ray.dir, triangle, triangle.a - ray.org);
    const std::uint32_t reference = reference_row(tree_.at(leaf), lanes_of(leaf))[lane];
    return t && offer_hit(reference, {*t + 0.0, is_front}, query);  // -0 + 0 is +0
  }

  bool offer_hit(std::uint32_t reference, const TriangleHit& crossing, Q& query) {
    Hit hit = prims_.blank_hit(reference);
    hit.t = crossing.t, hit.is_front = crossing.is_front;
    return query.offer(hit);
  }

  /// NaN where the block has others than the scene.
  TriangleVertices corners(WideId leaf, std::uint32_t lane) const {
    const std::byte* at = tree_.at(leaf);
    if (tree_.is_exact(at)) return stored_corners(at, lanes_of(leaf), lane);
    return {kNoCorner, kNoCorner, kNoCorner};
  }

  bool visit(std::uint32_t i, std::uint32_t reference, Q& query) {
    NoCounters uncounted;  // the kernel has counted the lanes
    return prims_.visit(reference, prepared(i), query, uncounted);
  }

  /// Bounds around the frame's t of a hit; they stay where there is none.
  void narrow(std::uint32_t i, double t) {
    if (!(t < double{kWideMostT} / 2)) return;
    known_.upper[i] = float_a_little_above(static_cast<float>(t));
    known_.lower[i] = float_a_little_below(static_cast<float>(t));
  }

  Ray given_ray(std::uint32_t i) const {
    return {Vec3d(given_.org(first_ + i)), Vec3d(given_.dir(first_ + i)),
            double{given_.t_min(first_ + i)}, double{given_.t_max(first_ + i)}};
  }

  const PreparedRay& prepared(std::uint32_t i) {
    if (prepared_index_ != first_ + i) {
      prepared_index_ = first_ + i;
      prims_.begin_ray();
      prepared_.emplace(given_ray(i), prims_.scene().world_frame());
    }
    return *prepared_;
  }

  void take_candidate(std::uint32_t i, double t) {
    const std::uint32_t reference = known_.reference[i];
    Hit& hit = answers_[i];
    hit.t = t, ids_.put(reference, hit.id);
    hit.is_front = known_.is_front(i), hit.reference = reference;
  }
  bool is_decided(std::uint32_t i) const { return (decided_ >> i & 1u) != 0; }

  /// The candidate with its canonical t.
  void settle(std::uint32_t i) {
    const WideId candidate = std::exchange(known_.candidate[i], 0u);
    const std::byte* leaf = tree_.at(candidate);
    const std::uint32_t lanes = lanes_of(candidate), lane = known_.lane[i];
    const Vec3d org(given_.org(first_ + i)), dir(given_.dir(first_ + i));
    TriangleVertices triangle;
    if (tree_.is_exact(leaf))
      triangle = stored_corners(leaf, lanes, lane);
    else
      prims_.scene().triangle(known_.reference[i], triangle);
    take_candidate(i, *crossing_t(org, dir, triangle, triangle.a - org) + 0.0);
  }

  const WideTree& tree_;
  const WideKernel& kernel_;
  Prims& prims_;
  WideIds ids_;
  const FloatRays& given_;
  C& counters_;
  WideTraverse traverse_;
  std::unique_ptr<float[]> room_;
  std::size_t first_ = 0;
  Answer* answers_ = nullptr;
  std::uint64_t decided_ = 0;  ///< bits: the answer is from the exact test; any: it is found by it
  std::size_t prepared_index_ = kNone;
  std::optional<PreparedRay> prepared_;
  WideRays rays_;
  WideAnswers known_;
};

}  // namespace strahl
