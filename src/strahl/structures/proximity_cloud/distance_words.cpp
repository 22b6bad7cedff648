#include <algorithm>
#include <span>

#include <strahl/structures/proximity_cloud/distance_words.h>

namespace strahl {
namespace {

constexpr const char* kStage = "measuring distances";

bool is_inside(const UniformCells& cells, int axis, int i) { return i >= 0 && i < cells.n(axis); }

/// Lowers every cell to one more than the least of its neighbours `steps` away, in an order in
/// which all of these come before it: cells ascend on the axes where `order` is 1.
template <class T>
void lower_to_neighbours(const UniformCells& cells, std::span<T> field, const CellPosition& order,
                         std::vector<CellPosition> steps, unsigned layers,
                         const BuildContext& context) {
  std::erase_if(steps, [&](const CellPosition& step) {
    return (step[0] != 0 && (layers & 1) != 0) || (step[1] != 0 && (layers & 2) != 0) ||
           (step[2] != 0 && (layers & 4) != 0);
  });
  const auto nth = [&](std::size_t axis, int i) {
    return order[axis] > 0 ? i : cells.n(static_cast<int>(axis)) - 1 - i;
  };
  for (int k = 0; k < cells.n(2); ++k) {
    context.check(static_cast<double>(k) / cells.n(2), kStage);
    for (int j = 0; j < cells.n(1); ++j)
      for (int i = 0; i < cells.n(0); ++i) {
        const CellPosition at{nth(0, i), nth(1, j), nth(2, k)};
        T& here = field[cells.index(at)];
        for (const CellPosition& step : steps) {
          const CellPosition to{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
          if (is_inside(cells, 0, to[0]) && is_inside(cells, 1, to[1]) &&
              is_inside(cells, 2, to[2]))
            here = std::min<T>(here, static_cast<T>(field[cells.index(to)] + 1));
        }
      }
  }
}

/// The neighbours, at most `most` apart by city blocks, that come before a cell in memory.
std::vector<CellPosition> neighbours_before(int most) {
  std::vector<CellPosition> steps;
  for (int z = -1; z <= 0; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const bool is_before = z < 0 || (z == 0 && (y < 0 || (y == 0 && x < 0)));
        if (is_before && x * x + y * y + z * z <= most) steps.push_back({x, y, z});
      }
  return steps;
}

/// A shortest way to the nearest list goes through one neighbour that is before or after the cell.
void measure_steps(const UniformCells& cells, const CellSpace& space, const BuildContext& context,
                   std::span<std::uint32_t> field) {
  std::vector<CellPosition> steps =
      neighbours_before(space.metric == CellMetric::city_block ? 1 : 3);
  lower_to_neighbours<std::uint32_t>(cells, field, {1, 1, 1}, steps, space.layers, context);
  for (CellPosition& step : steps) step = {-step[0], -step[1], -step[2]};
  lower_to_neighbours<std::uint32_t>(cells, field, {-1, -1, -1}, steps, space.layers, context);
}

/// Least over s of (p - s)^2 + f(s) for every p of a line, by the parabolas that are lowest there.
class LineEnvelope {
 public:
  explicit LineEnvelope(std::size_t longest) : value_(longest), parabolas_(longest) {}

  void replace(std::uint32_t* line, std::size_t stride, int count) {
    std::size_t size = 0;
    for (int s = 0; s < count; ++s) {
      const std::int64_t f = value_[static_cast<std::size_t>(s)] =
          line[static_cast<std::size_t>(s) * stride];
      if (f >= kFar) continue;
      while (size > 0 && first_below(parabolas_[size - 1].at, s) <= parabolas_[size - 1].from)
        --size;
      const std::int64_t from = size > 0 ? first_below(parabolas_[size - 1].at, s) : 0;
      if (from < count) parabolas_[size++] = {s, from};
    }
    if (size == 0) return;
    std::size_t lowest = 0;
    for (int p = 0; p < count; ++p) {
      while (lowest + 1 < size && parabolas_[lowest + 1].from <= p) ++lowest;
      const std::int64_t least = height(parabolas_[lowest].at, p);
      line[static_cast<std::size_t>(p) * stride] =
          static_cast<std::uint32_t>(std::min<std::int64_t>(least, kFar));
    }
  }

 private:
  struct Parabola {
    int at;
    std::int64_t from;  ///< the first place where it is the lowest so far
  };
  std::int64_t height(std::int64_t s, std::int64_t p) const {
    return (p - s) * (p - s) + value_[static_cast<std::size_t>(s)];
  }
  /// The first p >= 0 where the parabola at s is not above that at r < s.
  std::int64_t first_below(std::int64_t r, std::int64_t s) const {
    const std::int64_t rise = height(s, 0) - height(r, 0), per = 2 * (s - r);
    return rise <= 0 ? 0 : (rise + per - 1) / per;
  }

  std::vector<std::int64_t> value_;
  std::vector<Parabola> parabolas_;
};

void measure_squares(const UniformCells& cells, unsigned layers, const BuildContext& context,
                     std::span<std::uint32_t> field) {
  LineEnvelope envelope(static_cast<std::size_t>(std::max({cells.n(0), cells.n(1), cells.n(2)})));
  for (int axis = 0; axis < 3; ++axis) {
    if ((layers >> axis & 1) != 0) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int j = 0; j < cells.n(v); ++j) {
      context.check((axis + static_cast<double>(j) / cells.n(v)) / 3, kStage);
      for (int i = 0; i < cells.n(u); ++i) {
        const std::size_t first = static_cast<std::size_t>(i) * cells.stride(u) +
                                  static_cast<std::size_t>(j) * cells.stride(v);
        envelope.replace(field.data() + first, cells.stride(axis), cells.n(axis));
      }
    }
  }
}

/// Adds the 3 bits of one octant to words that hold the chessboard distance. A shortest way into an
/// octant goes through one of the 7 neighbours in it, which lie before the cell when it is scanned
/// from its far end.
void add_octant(const UniformCells& cells, unsigned octant, unsigned layers,
                const BuildContext& context, std::span<std::uint32_t> words,
                std::span<std::uint16_t> field) {
  constexpr std::uint16_t kOctantFar = 0x7fff;
  for (std::size_t i = 0; i < words.size(); ++i) field[i] = words[i] == 0 ? 0 : kOctantFar;
  CellPosition way, order;
  for (std::size_t a = 0; a < 3; ++a) way[a] = octant >> a & 1 ? -1 : 1, order[a] = -way[a];
  std::vector<CellPosition> steps;
  for (int k = 1; k < 8; ++k)
    steps.push_back({way[0] * (k & 1), way[1] * (k >> 1 & 1), way[2] * (k >> 2)});
  lower_to_neighbours<std::uint16_t>(cells, field, order, std::move(steps), layers, context);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == 0) continue;
    std::uint32_t code = 7;
    while (octant_distance(words[i] & kNearMask, code) > field[i]) --code;
    words[i] |= code << (7 + 3 * octant);
  }
}

}  // namespace

void fill_distance_words(const UniformCells& cells, const CellSpace& space,
                         const BuildContext& context, std::vector<std::uint32_t>& words) {
  for (std::uint32_t& word : words) word = word == 0 ? 0 : kFar;
  if (space.metric == CellMetric::euclid)
    measure_squares(cells, space.layers, context, words);
  else
    measure_steps(cells, space, context, words);
  if (space.metric == CellMetric::octant) {
    for (std::uint32_t& word : words) word = std::min(word, kNearMask);
    std::vector<std::uint16_t> field(words.size());
    for (unsigned octant = 0; octant < 8; ++octant)
      add_octant(cells, octant, space.layers, context, words, field);
  }
  for (std::uint32_t& word : words) word = word == 0 ? 0 : word | kEmptyCell;
}

}  // namespace strahl
