#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <strahl/structures/hug/size_groups.h>

namespace strahl {
namespace {

constexpr std::size_t kBins = 128;

double log_size(const Aabb& box) {
  // The largest side first: squares of extents may overflow. A point counts as very small.
  const Vec3d e = box.extent();
  const double side = norm_max(e);
  if (!(side > 0.0)) return -1024.0;
  const Vec3d unit = (1.0 / side) * e;
  return std::log2(side) + 0.5 * std::log2(dot(unit, unit));
}

/// Sums over the bins before each, so that those of any run of bins are differences.
struct Histogram {
  std::array<double, kBins + 1> count{}, sum{}, squares{};

  double mean(std::size_t begin, std::size_t end) const {
    return (sum[end] - sum[begin]) / (count[end] - count[begin]);
  }
  /// Of the squared deviations from the mean.
  double deviation(std::size_t begin, std::size_t end) const {
    const double n = count[end] - count[begin], s = sum[end] - sum[begin];
    return n > 0.0 ? std::max(0.0, squares[end] - squares[begin] - s * s / n) : 0.0;
  }
};

/// Ends of the runs of bins, the last one included: `groups` runs with the least deviation.
std::vector<std::size_t> best_cuts(const Histogram& h, std::size_t groups) {
  using Row = std::array<double, kBins + 1>;
  std::vector<Row> cost(groups);
  std::vector<std::array<std::size_t, kBins + 1>> cut(groups);
  for (std::size_t end = 0; end <= kBins; ++end) cost[0][end] = h.deviation(0, end);
  for (std::size_t g = 1; g < groups; ++g)
    for (std::size_t end = 0; end <= kBins; ++end) {
      cost[g][end] = std::numeric_limits<double>::infinity();
      for (std::size_t begin = 0; begin <= end; ++begin) {
        const double sum = cost[g - 1][begin] + h.deviation(begin, end);
        if (sum < cost[g][end]) cost[g][end] = sum, cut[g][end] = begin;
      }
    }
  std::vector<std::size_t> ends{kBins};
  for (std::size_t g = groups; g-- > 1;) ends.push_back(cut[g][ends.back()]);
  std::reverse(ends.begin(), ends.end());
  return ends;
}

/// Runs without primitives, and those too much like the one below, are not told apart.
std::vector<std::size_t> distinct(const Histogram& h, const std::vector<std::size_t>& ends,
                                  double log_ratio) {
  std::vector<std::size_t> kept;
  std::size_t begin = 0, before = 0;  // of the run and of the one below
  for (const std::size_t end : ends) {
    if (h.count[end] == h.count[begin]) continue;
    if (!kept.empty() && h.mean(begin, end) - h.mean(before, begin) < log_ratio)
      kept.pop_back();
    else
      before = begin;
    kept.push_back(end), begin = end;
  }
  if (!kept.empty()) kept.back() = kBins;
  return kept;
}

}  // namespace

SizeGroups find_size_groups(std::span<const PrimRef> refs, int most, double ratio) {
  std::vector<double> size(refs.size());
  for (std::size_t i = 0; i < refs.size(); ++i) size[i] = log_size(refs[i].box);
  const auto [lo, hi] = std::minmax_element(size.begin(), size.end());
  SizeGroups groups{std::vector<std::uint8_t>(refs.size()), {0.0}};
  if (size.empty()) return groups;
  const double begin = *lo, scale = *hi > *lo ? kBins / (*hi - *lo) : 0.0;
  const auto bin_of = [&](double s) {
    return std::min(kBins - 1, static_cast<std::size_t>((s - begin) * scale));
  };
  Histogram h;
  for (const double s : size) {
    const std::size_t above = bin_of(s) + 1;
    h.count[above] += 1.0, h.sum[above] += s, h.squares[above] += s * s;
  }
  for (std::size_t b = 0; b < kBins; ++b)
    h.count[b + 1] += h.count[b], h.sum[b + 1] += h.sum[b], h.squares[b + 1] += h.squares[b];
  const std::vector<std::size_t> ends =
      distinct(h, best_cuts(h, static_cast<std::size_t>(most)), std::log2(ratio));
  groups.mean.clear();
  for (std::size_t g = 0; g < ends.size(); ++g)
    groups.mean.push_back(std::exp2(h.mean(g == 0 ? 0 : ends[g - 1], ends[g])));
  for (std::size_t i = 0; i < size.size(); ++i)
    groups.group_of[i] = static_cast<std::uint8_t>(
        std::upper_bound(ends.begin(), ends.end(), bin_of(size[i])) - ends.begin());
  return groups;
}

}  // namespace strahl
