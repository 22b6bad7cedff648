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

/// Bins of one group.
struct Run {
  std::size_t begin, end;
};

/// Where to cut a run in two. Gaps come before cuts between neighbours, then the larger value.
struct Cut {
  std::size_t at = 0;
  bool is_gap = false;
  double value = 0.0;

  bool is_better_than(const Cut& other) const {
    return is_gap != other.is_gap ? is_gap : value > other.value;
  }
};

Cut widest_gap(const Histogram& h, const Run& run, double bin, double least) {
  Cut best;
  std::size_t last = run.begin;  // the occupied bin before
  for (std::size_t b = run.begin; b < run.end; ++b) {
    if (h.count[b + 1] == h.count[b]) continue;
    const double width = b > last ? static_cast<double>(b - last - 1) * bin : 0.0;
    if (width >= least && h.count[b] > h.count[run.begin])
      if (const Cut cut{b, true, width}; best.at == 0 || cut.is_better_than(best)) best = cut;
    last = b;
  }
  return best;
}

/// The two parts with the least deviation, if their means differ by as much.
Cut closest_parts(const Histogram& h, const Run& run, double least) {
  Cut best;
  const double whole = h.deviation(run.begin, run.end);
  for (std::size_t b = run.begin + 1; b < run.end; ++b) {
    if (h.count[b] == h.count[run.begin] || h.count[b] == h.count[run.end]) continue;
    const Cut cut{b, false, whole - h.deviation(run.begin, b) - h.deviation(b, run.end)};
    if (h.mean(b, run.end) - h.mean(run.begin, b) >= least && cut.is_better_than(best)) best = cut;
  }
  return best;
}

/// @param bin,least in powers of 2
std::vector<Run> cut_into_runs(const Histogram& h, std::size_t most, double bin, double least) {
  std::vector<Run> runs{{0, kBins}};
  while (runs.size() < most) {
    std::size_t in = 0;
    Cut best;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      Cut cut = widest_gap(h, runs[r], bin, least);
      if (cut.at == 0) cut = closest_parts(h, runs[r], least);
      if (cut.at > 0 && (best.at == 0 || cut.is_better_than(best))) best = cut, in = r;
    }
    if (best.at == 0) break;
    const Run above{best.at, runs[in].end};
    runs[in].end = best.at;
    runs.insert(runs.begin() + static_cast<std::ptrdiff_t>(in) + 1, above);
  }
  return runs;
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
  const double bin = (*hi - *lo) / kBins;
  const std::vector<Run> runs =
      cut_into_runs(h, static_cast<std::size_t>(most), bin, std::log2(ratio));
  groups.mean.clear();
  for (const Run& run : runs) groups.mean.push_back(std::exp2(h.mean(run.begin, run.end)));
  for (std::size_t i = 0; i < size.size(); ++i) {
    const auto above =
        std::upper_bound(runs.begin(), runs.end(), bin_of(size[i]),
                         [](std::size_t at, const Run& run) { return at < run.end; });
    groups.group_of[i] = static_cast<std::uint8_t>(above - runs.begin());
  }
  return groups;
}

}  // namespace strahl
