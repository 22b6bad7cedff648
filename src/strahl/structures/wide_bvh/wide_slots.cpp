#include <array>
#include <cstdint>

#include <strahl/math/aabb.h>
#include <strahl/structures/wide_bvh/wide_layout.h>

namespace strahl {
namespace {

constexpr auto kMaxWidth = static_cast<std::size_t>(CollapseRules::kMaxWidth);

/// The octant that each child fits best of those that have room left. Only children whose octant
/// has been filled look for another.
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
      fits_[child] = norm1(offset);
    }
  }

  void run(std::span<int> slots) {
    for (std::size_t placed = 0; placed < count_; ++placed) {
      const std::size_t child = next();
      const std::size_t octant = octants_[child];
      slots[child] = static_cast<int>(octant) * room_ + used_[octant]++;
      fits_[child] = kPlaced;
      if (used_[octant] < room_) continue;
      for (std::size_t other = 0; other < count_; ++other)
        if (octants_[other] == octant && fits_[other] != kPlaced) look(other);
    }
  }

 private:
  static constexpr double kPlaced = -Aabb::kInf;

  void look(std::size_t child) {
    const Vec3d& offset = offsets_[child];
    fits_[child] = kPlaced;
    for (std::size_t octant = 0; octant < 8; ++octant) {
      if (used_[octant] >= room_) continue;
      const double fit = ((octant & 1u) != 0 ? offset.x : -offset.x) +
                         ((octant & 2u) != 0 ? offset.y : -offset.y) +
                         ((octant & 4u) != 0 ? offset.z : -offset.z);
      if (fit > fits_[child]) fits_[child] = fit, octants_[child] = octant;
    }
  }

  std::size_t next() const {
    std::size_t best = 0;
    for (std::size_t child = 1; child < count_; ++child)
      best = fits_[child] > fits_[best] ? child : best;
    return best;
  }

  std::size_t count_;
  int room_;  ///< slots of an octant
  std::array<Vec3d, kMaxWidth> offsets_;
  std::array<double, kMaxWidth> fits_;
  std::array<std::size_t, kMaxWidth> octants_;
  std::array<int, 8> used_{};
};

}  // namespace

void assign_slots(std::span<const Vec3d> centers, const Vec3d& middle, int width,
                  std::span<int> slots) {
  SlotChoice(centers, middle, width).run(slots);
}

}  // namespace strahl
