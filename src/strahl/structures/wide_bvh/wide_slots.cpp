#include <array>
#include <cstdint>
#include <utility>

#include <strahl/math/aabb.h>
#include <strahl/structures/wide_bvh/wide_layout.h>

namespace strahl {
namespace {

constexpr auto kMaxWidth = static_cast<std::size_t>(CollapseRules::kMaxWidth);

/// Octants of a node's children: the best fitting child first, then exchanges. A slot is any of its
/// octant.
class SlotChoice {
 public:
  SlotChoice(std::span<const Vec3d> centers, const Vec3d& middle, int width)
      : count_(centers.size()), room_(width / 8) {
    for (std::size_t child = 0; child < count_; ++child) {
      const Vec3d offset = centers[child] - middle;
      offsets_[child] = offset;
      octants_[child] = static_cast<std::size_t>(offset.x > 0.0) |
                        static_cast<std::size_t>(offset.y > 0.0) << 1 |
                        static_cast<std::size_t>(offset.z > 0.0) << 2;
      waiting_[child] = norm1(offset);
      least_gain_[child] = kLeastGain * waiting_[child];
    }
  }

  /// Only children whose octant has been filled look for another.
  void fill() {
    for (std::size_t placed = 0; placed < count_; ++placed) {
      const std::size_t child = next(), octant = octants_[child];
      waiting_[child] = kPlaced;
      if (++used_[octant] < room_) continue;
      for (std::size_t other = 0; other < count_; ++other)
        if (octants_[other] == octant && waiting_[other] != kPlaced) look(other);
    }
  }

  /// Exchanges and moves as long as they fit better; those that fill() took last had little choice.
  void improve() {
    bool is_better = has_displaced_;
    for (int round = 0; round < kMostRounds && is_better; ++round) {
      is_better = false;
      for (std::size_t a = 0; a < count_; ++a) {
        for (std::size_t b = a + 1; b < count_; ++b) is_better |= exchange(a, b);
        for (std::size_t octant = 0; octant < 8; ++octant) is_better |= move(a, octant);
      }
    }
  }

  void write(std::span<int> slots) const {
    std::array<int, 8> taken{};
    for (std::size_t child = 0; child < count_; ++child) {
      const std::size_t octant = octants_[child];
      slots[child] = static_cast<int>(octant) * room_ + taken[octant]++;
    }
  }

 private:
  static constexpr double kPlaced = -Aabb::kInf;
  static constexpr int kMostRounds = 8;
  static constexpr double kLeastGain = 1e-6;  ///< relative: roundings are no gain

  double fit(std::size_t child, std::size_t octant) const {
    const Vec3d& offset = offsets_[child];
    return ((octant & 1u) != 0 ? offset.x : -offset.x) +
           ((octant & 2u) != 0 ? offset.y : -offset.y) +
           ((octant & 4u) != 0 ? offset.z : -offset.z);
  }

  void look(std::size_t child) {
    has_displaced_ = true;
    waiting_[child] = kPlaced;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      if (used_[octant] >= room_) continue;
      const double here = fit(child, octant);
      if (here > waiting_[child]) waiting_[child] = here, octants_[child] = octant;
    }
  }

  std::size_t next() const {
    std::size_t best = 0;
    for (std::size_t child = 1; child < count_; ++child)
      best = waiting_[child] > waiting_[best] ? child : best;
    return best;
  }

  bool exchange(std::size_t a, std::size_t b) {
    const std::size_t of_a = octants_[a], of_b = octants_[b];
    if (of_a == of_b) return false;
    const double now = fit(a, of_a) + fit(b, of_b), then = fit(a, of_b) + fit(b, of_a);
    if (!(then > now + least_gain_[a] + least_gain_[b])) return false;
    std::swap(octants_[a], octants_[b]);
    return true;
  }

  bool move(std::size_t child, std::size_t octant) {
    const std::size_t from = octants_[child];
    if (octant == from || used_[octant] >= room_) return false;
    if (!(fit(child, octant) > fit(child, from) + least_gain_[child])) return false;
    --used_[from], ++used_[octant];
    octants_[child] = octant;
    return true;
  }

  std::size_t count_;
  int room_;  ///< slots of an octant
  bool has_displaced_ = false;
  std::array<Vec3d, kMaxWidth> offsets_;
  std::array<double, kMaxWidth> waiting_;  ///< fits of those not placed yet
  std::array<double, kMaxWidth> least_gain_;
  std::array<std::size_t, kMaxWidth> octants_;
  std::array<int, 8> used_{};
};

}  // namespace

void assign_slots(std::span<const Vec3d> centers, const Vec3d& middle, int width,
                  std::span<int> slots) {
  SlotChoice choice(centers, middle, width);
  choice.fill();
  choice.improve();
  choice.write(slots);
}

}  // namespace strahl
