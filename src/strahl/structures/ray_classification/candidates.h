// structures/ray_classification/candidates.h - what the lists of cells are made of: small groups of
// neighbouring primitives. Immutable.
//
// Source: the candidate objects of [ArvoKirk1987]; a group takes the place of an object with its
//   bounding volume, so that lists are a few times shorter.
// Layout: a cache line per group: its box and its run of references; the box is that of the exact
//   filter, in world units. Outlines of the primitives in local units, as floats.
// Invariants: every primitive that can be hit is in one group; references of a group ascend; for
//   each face an order of all groups by where rays of that face enter them first.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/base/hash.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/ray_classification/beam.h>

namespace strahl {

struct alignas(64) CandidateGroup {
  Aabb box;
  std::uint32_t first = 0, count = 0;
};

class Candidates {
 public:
  Candidates() = default;
  /// @param group_size most primitives in a group
  Candidates(const PrimitiveSource& source, int group_size, const BuildContext& context);

  bool empty() const { return groups_.empty(); }
  std::size_t primitive_count() const { return references_.size(); }
  const RaySpace& space() const { return space_; }
  std::span<const CandidateGroup> groups() const { return groups_; }
  const CandidateGroup& group(std::uint32_t i) const { return groups_[i]; }
  std::span<const std::uint32_t> references(const CandidateGroup& g) const {
    return {references_.data() + g.first, g.count};
  }
  /// All groups, those first that rays of the face can enter first.
  std::span<const std::uint32_t> order(int face) const { return order_[index(face)]; }

  /// The groups of the list that a ray of the beam may hit, in the same order, appended.
  /// @param culls leave out what can only be hit from behind
  void filter(std::span<const std::uint32_t> list, const Beam& beam, bool culls,
              std::vector<std::uint32_t>& out) const;
  bool may_hit(const CandidateGroup& group, const Beam& beam, bool culls) const;

  std::uint64_t bytes() const;
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  friend class RayClassificationBreaker;  ///< plants faults for the tests

  static std::size_t index(int face) { return static_cast<std::size_t>(face); }
  void take_groups(const struct Tree& tree);
  void store_outlines(const PrimitiveSource& source, const BuildContext& context);
  void sort_orders();
  std::span<const StoredBall> balls_of(std::size_t place) const {
    return std::span(balls_).subspan(first_ball_[place],
                                     first_ball_[place + 1] - first_ball_[place]);
  }
  bool holds_outline(std::size_t place, const PrimitiveSource& source) const;
  bool comes_first(int face, std::uint32_t a, std::uint32_t b) const;
  /// The two halves of the question for one primitive: from the right side, and at all.
  bool may_see(std::size_t place, const Beam& beam, bool culls) const;
  bool may_meet(std::size_t place, const Beam& beam) const;

  RaySpace space_;
  std::vector<CandidateGroup> groups_;
  std::vector<std::uint32_t> references_;
  std::vector<StoredBall> balls_;
  std::vector<std::uint32_t> first_ball_;  ///< per place in references_, and the end
  std::array<std::vector<std::uint32_t>, kFaces> order_;
};

}  // namespace strahl
