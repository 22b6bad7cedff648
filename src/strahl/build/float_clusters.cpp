#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <strahl/base/large_pages.h>
#include <strahl/build/float_clusters.h>

namespace strahl {
namespace {

constexpr int kBits = 10;  // per axis, and per pass of the sort
constexpr std::uint32_t kValues = 1u << kBits;
constexpr std::size_t kChunk = std::size_t{1} << 16;

/// Code in the high half, index in the low one.
using Place = std::uint64_t;

std::uint32_t code_of(Place place) { return static_cast<std::uint32_t>(place >> 32); }

/// Codes of doubled centres in a cube around them all.
class Curve {
 public:
  explicit Curve(const FloatBox& centers) : least_{centers.lo[0], centers.lo[1], centers.lo[2], 0} {
    const Float4 extent = centers.extent();
    const float longest = std::max({extent[0], extent[1], extent[2]});
    const float per_unit =
        std::min(static_cast<float>(kValues) / longest, std::numeric_limits<float>::max());
    per_unit_ = Float4{per_unit, per_unit, per_unit, 0};
  }
  std::uint32_t code(const FloatRef& ref) const {
    Float4 center = ref.box().doubled_center();
    center[3] = 0;
    const Float4 place = (center - least_) * per_unit_;
    Int4 x = __builtin_convertvector(min4(place, all4(kValues - 1)), Int4);
    x = (x | x << 16) & 0x030000ff;  // two zero bits before each bit
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    x = (x | x << 2) & 0x09249249;
    return static_cast<std::uint32_t>(x[0] << 2 | x[1] << 1 | x[2]);
  }

 private:
  Float4 least_, per_unit_;
};

/// Stable passes over 10 bits each; chunks count and scatter on their own.
class RadixSort {
 public:
  RadixSort(std::size_t count, const Executor& executor)
      : executor_(executor), count_(count), next_((count + kChunk - 1) / kChunk) {}

  void pass(const Place* from, Place* to, int shift) {
    const auto digit = [shift](Place place) { return place >> shift & (kValues - 1); };
    executor_.parallel_for(0, count_, kChunk, [&](std::size_t begin, std::size_t end) {
      auto& counts = next_[begin / kChunk];
      counts.fill(0);
      for (std::size_t i = begin; i < end; ++i) ++counts[digit(from[i])];
    });
    std::uint32_t sum = 0;
    for (std::uint32_t value = 0; value < kValues; ++value)
      for (auto& chunk : next_) {
        const std::uint32_t count = chunk[value];
        chunk[value] = sum, sum += count;
      }
    executor_.parallel_for(0, count_, kChunk, [&](std::size_t begin, std::size_t end) {
      auto& next = next_[begin / kChunk];
      for (std::size_t i = begin; i < end; ++i) to[next[digit(from[i])]++] = from[i];
    });
  }

 private:
  const Executor& executor_;
  std::size_t count_;
  std::vector<std::array<std::uint32_t, kValues>> next_;
};

std::unique_ptr<Place[]> sorted_places(std::span<const FloatRef> refs, const FloatBox& centers,
                                       const BuildContext& context) {
  auto places = std::make_unique_for_overwrite<Place[]>(refs.size());
  auto other = std::make_unique_for_overwrite<Place[]>(refs.size());
  prefer_large_pages(places.get(), refs.size() * sizeof(Place));
  prefer_large_pages(other.get(), refs.size() * sizeof(Place));
  const Curve curve(centers);
  context.executor.parallel_for(0, refs.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    context.check(static_cast<double>(begin) / static_cast<double>(refs.size()), "sorting");
    for (std::size_t i = begin; i < end; ++i) places[i] = Place{curve.code(refs[i])} << 32 | i;
  });
  RadixSort sort(refs.size(), context.executor);
  sort.pass(places.get(), other.get(), 32);
  sort.pass(other.get(), places.get(), 32 + kBits);
  sort.pass(places.get(), other.get(), 32 + 2 * kBits);
  return other;
}

/// Where clusters begin and end in the order of the curve.
class Cutter {
 public:
  Cutter(const Place* places, std::uint32_t most, std::vector<FloatRef>& clusters)
      : places_(places), most_(most), clusters_(clusters) {}

  void cut(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t differ = code_of(places_[begin]) ^ code_of(places_[end - 1]);
    if (end - begin <= most_ || differ == 0) {
      clusters_.push_back({{}, begin, {}, end - begin});
      return;
    }
    const Place bit = Place{std::bit_floor(differ)} << 32;
    const Place* middle = std::partition_point(places_ + begin, places_ + end,
                                               [bit](Place place) { return (place & bit) == 0; });
    cut(begin, static_cast<std::uint32_t>(middle - places_));
    cut(static_cast<std::uint32_t>(middle - places_), end);
  }

 private:
  const Place* places_;
  std::uint32_t most_;
  std::vector<FloatRef>& clusters_;
};

}  // namespace

FloatClusters make_clusters(std::span<const FloatRef> refs, const FloatBox& centers,
                            std::uint32_t most, const BuildContext& context) {
  const auto places = sorted_places(refs, centers, context);
  FloatClusters made;
  made.clusters.reserve(4 * refs.size() / most);
  Cutter(places.get(), most, made.clusters).cut(0, static_cast<std::uint32_t>(refs.size()));
  made.sorted = std::make_unique_for_overwrite<FloatRef[]>(refs.size());
  prefer_large_pages(made.sorted.get(), refs.size() * sizeof(FloatRef));
  context.executor.parallel_for(
      0, made.clusters.size(), kChunk / most, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
          FloatRef& cluster = made.clusters[c];
          FloatBox box = FloatBox::empty();
          for (std::uint32_t i = cluster.reference; i < cluster.reference + cluster.weight; ++i) {
            made.sorted[i] = refs[static_cast<std::uint32_t>(places[i])];
            box.extend(made.sorted[i].box());
          }
          for (int axis = 0; axis < 3; ++axis)
            cluster.lo[axis] = box.lo[axis], cluster.minus_hi[axis] = box.minus_hi[axis];
        }
      });
  return made;
}

}  // namespace strahl
