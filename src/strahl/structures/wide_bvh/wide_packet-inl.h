// structures/wide_bvh/wide_packet-inl.h - coherent rays of a block together, as long as that pays.
//
// Source: packets culled as one [Reshetov2005], with the rays that are still wanted as bits beside
//   each waiting node [BarringerAkenineMoeller2014]; both here over wide nodes.
// A node's children are tested once, against the beam of all rays; each child that may be met is
//   tested, a ray per lane, when its turn comes, by when hits have shortened the rays. A block that
//   most rays reach is tested triangle by triangle, a ray per lane, too. Where a node's children
//   are many and its rays few, flights take those rays through what lies below it.
// Bounds, certain hits and what is left to the exact test are those of single rays, so is the
//   answer.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_PACKET_INL_H_
#undef STRAHL_WIDE_PACKET_INL_H_
#else
#define STRAHL_WIDE_PACKET_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_beam-inl.h>
#include <strahl/structures/wide_bvh/wide_flight-inl.h>
#include <strahl/structures/wide_bvh/wide_group-inl.h>
#include <strahl/structures/wide_bvh/wide_pencil-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// A whole block of rays.
template <int W, WideMode M>
class Packet {
 public:
  explicit Packet(WideJob& job)
      : job_(job),
        answers_(job.answers),
        beam_(job.rays, job.answers.upper, static_cast<float>(job.tree.frame.reach)),
        backward_((beam_.signs() * (W / 8)) ^ (W - 1)),
        flight_(job) {
    if (beam_.has_one_origin()) cull_ = PencilCull<W>(job.rays);
    find_farthest();
  }

  void run() {
    divide(job_.tree.root, live_);
    while (top_ > 0 && live_ != 0) visit(waiting_[--top_]);
  }

 private:
  using L = WideLanes<W>;
  using D = typename L::D;
  static constexpr std::uint32_t kLanes = static_cast<std::uint32_t>(L::kLanes);
  static constexpr std::uint64_t kGroup = (std::uint64_t{1} << kLanes) - 1;
  /// A child costs a packet what it costs so many rays to visit a node, more where the rays are of
  /// several octants; a ray's test of a block costs as many tests of a triangle by a register.
  /// With registers of 8 rays more so, but less where all begin at one point.
  static constexpr int kRaysPerChild = kCompresses ? 3 : 10;
  static constexpr int kPencilRaysPerChild = kCompresses ? 3 : 6;
  static constexpr int kMixedRaysPerChild = kCompresses ? 5 : 12;
  static constexpr int kTrianglesPerTest = 4;

  /// A child that the beam may meet. Its box is in its parent.
  struct Waiting {
    std::uint64_t rays;
    const std::byte* parent;
    WideId id;
    std::uint32_t slot;
    float enter;
  };

  void visit(const Waiting& child) {
    if (!(child.enter <= farthest_)) return;
    const std::uint64_t rays = meeting(child.parent, child.slot, child.rays & live_);
    if (rays == 0) return;
    if (!is_leaf(child.id))
      divide(child.id, rays);
    else if (pays(child.id, rays))
      beam_.has_one_origin() ? test_block<true>(child.id, rays) : test_block<false>(child.id, rays);
    else
      hand_over(child.id, rays);
  }

  /// Whether testing triangle by triangle is cheaper than ray by ray.
  static bool pays(WideId leaf, std::uint64_t rays) {
    std::uint32_t groups = 0;
    for (std::uint32_t first = 0; first < kWideBlock; first += kLanes)
      groups += (rays >> first & kGroup) != 0;
    return lanes_of(leaf) * groups <
           kTrianglesPerTest * static_cast<std::uint32_t>(__builtin_popcountll(rays));
  }

  int rays_per_child() const {
    if (!beam_.has_one_octant()) return kMixedRaysPerChild;
    return beam_.has_one_origin() ? kPencilRaysPerChild : kRaysPerChild;
  }

  void divide(WideId id, std::uint64_t rays) {
    const std::byte* node = job_.tree.at(id);
    typename NodeTest<W>::Hits hits;
    beam_.test(node, hn::Set(D(), farthest_), hits);
    if (rays_per_child() * __builtin_popcount(hits.bits) > __builtin_popcountll(rays))
      return hand_over(id, rays);
    alignas(64) float enter[W];
    hn::Store(hits.enter[0], D(), enter);
    std::uint32_t farthest_first = visiting_order<W>(hits.bits, backward_);
    for (; farthest_first != 0; farthest_first &= farthest_first - 1) {
      const auto slot = static_cast<std::uint32_t>(__builtin_ctz(farthest_first)) ^ backward_;
      waiting_[top_++] = {rays, node, child_row(node, W)[slot], slot, enter[slot]};
    }
    if (top_ > 0) prefetch<W>(job_.tree.at(waiting_[top_ - 1].id));
  }

  /// Those of the rays that may meet the box of a child.
  HWY_INLINE std::uint64_t meeting(const std::byte* node, std::uint32_t slot,
                                   std::uint64_t rays) const {
    std::uint64_t met = 0;
    for (std::uint32_t first = 0; first < kWideBlock; first += kLanes) {
      if ((rays >> first & kGroup) == 0) continue;
      auto enter = hn::Load(D(), job_.rays.t_enter + first);
      auto leave = hn::Load(D(), answers_.upper + first);
      for (int a = 0; a < 3; ++a) narrow(node, slot, a, first, enter, leave);
      met |= std::uint64_t{bits_of(D(), hn::Le(enter, leave))} << first;
    }
    return met & rays;
  }
  /// To the part between the planes of one axis.
  HWY_INLINE void narrow(const std::byte* node, std::uint32_t slot, int a, std::uint32_t first,
                         typename L::V& enter, typename L::V& leave) const {
    const auto rcp = hn::Load(D(), job_.rays.rcp[a] + first);
    const auto near = hn::Load(D(), job_.rays.near[a] + first);
    const auto far = hn::Load(D(), job_.rays.far[a] + first);
    const auto low = plane(node, a, slot), high = plane(node, a + 3, slot);
    if (beam_.has_one_octant()) {
      const bool down = (beam_.signs() >> a & 1u) != 0;
      enter = hn::Max(enter, hn::MulAdd(down ? high : low, rcp, near));
      leave = hn::Min(leave, hn::MulAdd(down ? low : high, rcp, far));
    } else {
      enter = hn::Max(enter, hn::Min(hn::MulAdd(low, rcp, near), hn::MulAdd(high, rcp, near)));
      leave = hn::Min(leave, hn::Max(hn::MulAdd(low, rcp, far), hn::MulAdd(high, rcp, far)));
    }
  }
  HWY_INLINE static typename L::V plane(const std::byte* node, int row, std::uint32_t slot) {
    return hn::Set(D(), plane_row(node, W, row)[slot]);
  }

  template <bool kIsPencil>
  void test_block(WideId id, std::uint64_t rays) {
    ExpandedBlock<W> room;
    SeenBlock<W> block;
    block.id = id, block.view = view<W>(job_.tree.at(id), lanes_of(id), room);
    std::uint32_t triangles = (2u << (block.view.lanes - 1)) - 1;
    if constexpr (kIsPencil) {
      LeafTest<W>(job_.rays, 0).project(block.view, block.pencil);
      triangles &= cull_.lanes(block.pencil);
    }
    bool is_shorter = false;
    for (std::uint32_t first = 0; first < kWideBlock; first += kLanes) {
      const auto reaching = static_cast<std::uint32_t>(rays >> first & kGroup);
      if (reaching == 0) continue;
      Group<W, M> group(job_, first, reaching);
      is_shorter |= group.template run<kIsPencil>(block, triangles);
      if (M == WideMode::any) end(std::uint64_t{reaching & ~group.rays()} << first);
    }
    if (is_shorter) find_farthest();
  }

  void hand_over(WideId id, std::uint64_t rays) {
    end(flight_.run(rays, id));
    find_farthest();
  }

  /// They meet nothing any more.
  void end(std::uint64_t rays) {
    live_ &= ~rays;
    for (; rays != 0; rays &= rays - 1) answers_.upper[__builtin_ctzll(rays)] = -1.0f;
  }
  void find_farthest() {
    auto most = hn::Load(D(), answers_.upper);
    for (std::uint32_t first = kLanes; first < kWideBlock; first += kLanes)
      most = hn::Max(most, hn::Load(D(), answers_.upper + first));
    farthest_ = hn::GetLane(hn::MaxOfLanes(D(), most));
  }

  WideJob& job_;
  WideAnswers& answers_;
  Beam<W> beam_;
  PencilCull<W> cull_;      ///< of rays from one origin
  std::uint32_t backward_;  ///< slot XOR it: farthest first
  Flight<W, M> flight_;
  std::uint64_t live_ = ~std::uint64_t{0};
  float farthest_;  ///< bound of any ray's hits
  std::size_t top_ = 0;
  Waiting waiting_[wide_stack_room(W, kWideMaxDepth)];
};

/// Rays of a block: together where they can be, else each on its way, all at once.
template <int W, WideMode M>
void fly(WideJob& job, std::uint64_t rays) {
  if (rays == 0) return;
  if (is_leaf(job.tree.root)) return traverse<W, M, false>(job, rays);
  if (rays != ~std::uint64_t{0}) {
    Flight<W, M>(job).run(rays, job.tree.root);
    return;
  }
  Packet<W, M>(job).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
