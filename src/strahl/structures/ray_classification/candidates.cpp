#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <strahl/build/object_tree.h>
#include <strahl/geometry/outline.h>
#include <strahl/structures/ray_classification/candidates.h>

namespace strahl {
namespace {

/// A division must be worth it twenty times, so groups are filled.
constexpr SahCost kGroupCost{1.0, 0.05};
/// Groups smaller than this share of a beam are told by their boxes alone.
constexpr double kSmall = 0.25;
constexpr int kBins = 32, kMaxDepth = 64;
constexpr std::uint32_t kReportEvery = 1u << 14;

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("ray_classification: ") + broken);
}

StoredBall stored(const Ball& ball, const RaySpace& space) {
  const Vec3d c = space.local(ball.center);
  float radius = static_cast<float>(space.local_length(ball.radius));
  if (ball.radius > 0.0) radius = std::nextafter(radius, HUGE_VALF);
  return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z), radius};
}

}  // namespace

Candidates::Candidates(const PrimitiveSource& source, int group_size, const BuildContext& context) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return;
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  space_ = RaySpace(box);
  context.require_memory(refs.size() * (sizeof(PrimRef) + 2 * sizeof(TreeNode) + 4),
                         "ray_classification");
  const auto splitter = make_binned_splitter(refs, kBins, kGroupCost);
  const LeafRules rules{kGroupCost, static_cast<std::size_t>(group_size), kMaxDepth};
  take_groups(build_object_tree(*splitter, refs.size(), box, rules, context));
  std::vector<PrimRef>().swap(refs);
  store_outlines(source, context);
  sort_orders();
  context.require_memory(bytes(), "ray_classification");
}

void Candidates::take_groups(const Tree& tree) {
  references_ = tree.references;
  groups_.reserve((tree.nodes.size() + 1) / 2);
  for (const TreeNode& node : tree.nodes)
    if (node.is_leaf()) groups_.push_back({node.box, node.first, node.count});
}

void Candidates::store_outlines(const PrimitiveSource& source, const BuildContext& context) {
  first_ball_.reserve(references_.size() + 1);
  for (std::size_t place = 0; place < references_.size(); ++place) {
    if (place % kReportEvery == 0) {
      context.check(static_cast<double>(place) / static_cast<double>(references_.size()),
                    "outlining primitives");
      context.require_memory(bytes(), "ray_classification");
    }
    first_ball_.push_back(static_cast<std::uint32_t>(balls_.size()));
    const Outline outline = source.outline(references_[place]);
    for (const Ball& ball : outline.balls()) balls_.push_back(stored(ball, space_));
    if (balls_.size() > UINT32_MAX)
      throw Error(ErrorCode::resource, "more than 2^32 corners of outlines", "ray_classification");
  }
  first_ball_.push_back(static_cast<std::uint32_t>(balls_.size()));
  balls_.shrink_to_fit();
}

bool Candidates::comes_first(int face, std::uint32_t a, std::uint32_t b) const {
  const int axis = face / 2;
  const double at_a = face % 2 == 0 ? groups_[a].box.lo[axis] : -groups_[a].box.hi[axis];
  const double at_b = face % 2 == 0 ? groups_[b].box.lo[axis] : -groups_[b].box.hi[axis];
  return at_a != at_b ? at_a < at_b : a < b;
}

void Candidates::sort_orders() {
  for (int face = 0; face < kFaces; ++face) {
    std::vector<std::uint32_t>& order = order_[index(face)];
    order.resize(groups_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return comes_first(face, a, b); });
  }
}

bool Candidates::may_see(std::size_t place, const Beam& beam, bool culls) const {
  const std::span<const StoredBall> balls = balls_of(place);
  return !culls || balls.size() != 3 || beam.may_see_front(balls);
}

bool Candidates::may_meet(std::size_t place, const Beam& beam) const {
  const std::span<const StoredBall> balls = balls_of(place);
  if (balls.empty()) return true;
  return balls.size() == 3 ? beam.may_meet_triangle(balls) : beam.may_meet_hull(balls);
}

bool Candidates::may_hit(const CandidateGroup& group, const Beam& beam, bool culls) const {
  const Vec3d lo = space_.local(group.box.lo), hi = space_.local(group.box.hi);
  if (!beam.may_meet(lo, hi)) return false;
  // A look at the primitives pays where they are not small beside the beam.
  const bool is_small = norm_max(hi - lo) < kSmall * beam.breadth();
  if (is_small && !culls) return true;
  for (std::size_t place = group.first; place < group.first + std::size_t{group.count}; ++place)
    if (may_see(place, beam, culls) && (is_small || may_meet(place, beam))) return true;
  return false;
}

void Candidates::filter(std::span<const std::uint32_t> list, const Beam& beam, bool culls,
                        std::vector<std::uint32_t>& out) const {
  for (const std::uint32_t i : list)
    if (may_hit(groups_[i], beam, culls)) out.push_back(i);
}

bool Candidates::holds_outline(std::size_t place, const PrimitiveSource& source) const {
  const Outline outline = source.outline(references_[place]);
  return std::ranges::equal(balls_of(place), outline.balls(),
                            [&](const StoredBall& own, const Ball& ball) {
                              const StoredBall other = stored(ball, space_);
                              return own.x == other.x && own.y == other.y && own.z == other.z &&
                                     own.radius == other.radius;
                            });
}

std::uint64_t Candidates::bytes() const {
  std::uint64_t sum = groups_.capacity() * sizeof(CandidateGroup) + 4 * references_.capacity() +
                      balls_.capacity() * sizeof(StoredBall) + 4 * first_ball_.capacity();
  for (const auto& order : order_) sum += 4 * order.capacity();
  return sum;
}

void Candidates::validate(const PrimitiveSource& source) const {
  std::vector<std::uint32_t> seen(source.size(), 0);
  std::size_t next = 0;
  for (const CandidateGroup& group : groups_) {
    demand(group.first == next && group.count > 0, "groups do not tile the references");
    next += group.count;
    demand(next <= references_.size(), "a group's references are out of range");
    for (std::size_t place = group.first; place < next; ++place) {
      const std::uint32_t reference = references_[place];
      demand(reference < source.size(), "a reference is out of range");
      demand(place == group.first || references_[place - 1] < reference,
             "references of a group do not ascend");
      demand(group.box.contains(source.bounds(reference)), "a group does not hold a primitive");
      demand(space_.box().contains(group.box), "a group is outside of the scene's box");
      demand(holds_outline(place, source), "an outline is not that of its primitive");
      ++seen[reference];
    }
  }
  demand(next == references_.size(), "references are in no group");
  for (std::uint32_t i = 0; i < source.size(); ++i)
    demand(seen[i] == (source.bounds(i).is_empty() ? 0u : 1u),
           "a primitive is not in exactly one group");
  for (int face = 0; face < kFaces; ++face) {
    const auto list = order(face);
    demand(list.size() == groups_.size(), "an order is not of all groups");
    for (std::size_t i = 1; i < list.size(); ++i)
      demand(comes_first(face, list[i - 1], list[i]), "an order is wrong");
  }
}

void Candidates::hash_into(Hash64& hash) const {
  for (const CandidateGroup& group : groups_) {
    for (int axis = 0; axis < 3; ++axis) hash.add(group.box.lo[axis]), hash.add(group.box.hi[axis]);
    hash.add(group.first), hash.add(group.count);
  }
  hash.add(std::span<const std::uint32_t>(references_));
  hash.add(std::span<const std::uint32_t>(first_ball_));
  for (const StoredBall& b : balls_)
    hash.add(b.x), hash.add(b.y), hash.add(b.z), hash.add(b.radius);
}

}  // namespace strahl
