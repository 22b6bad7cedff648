#include <algorithm>
#include <atomic>

#include <strahl/base/error.h>
#include <strahl/build/memory_meter.h>
#include <strahl/build/nested_grids.h>
#include <strahl/build/sah.h>

namespace strahl {
namespace {

constexpr std::size_t kHeaderWords = sizeof(NestedGrid) / sizeof(std::uint32_t);
/// A quarter of the words is for cells, half for references: so the header fits, too.
constexpr double kLeastWords = 5.0 * kHeaderWords;
/// Growing arrays own up to twice what they hold.
constexpr std::uint64_t kGrowth = 2;
/// To enter a grid, in steps.
constexpr double kEnterCost = 2.0;
/// Cells per task, and the number of primitives after which progress is told.
constexpr std::size_t kGrain = 64, kReportEvery = 1u << 12;

class NestedGridBuilder {
 public:
  NestedGridBuilder(const NestedGridInput& input, const NestingOptions& options,
                    const BuildContext& context, const char* what)
      : input_(input),
        options_(options),
        context_(context),
        what_(what),
        meter_(context, what),
        quiet_(context) {
    quiet_.progress = nullptr;
    sub_.resolution = options.sub_resolution, sub_.density = options.sub_density;
    sub_.nx = sub_.ny = sub_.nz = options.sub_n;
  }

  std::uint32_t run(const CellGridOptions& options, NestedGrids& out) {
    const std::span<const PrimRef> refs = input_.refs;
    Aabb box;
    for (const PrimRef& ref : refs) box.extend(ref.box);
    if (box.is_empty()) box = {{}, {}};
    meter_.take(input_.owned + refs.size_bytes() + out.bytes());
    const auto grid = fit({input_.source, refs, input_.exact, UINT32_MAX}, box, options);
    if (!grid) throw Error(ErrorCode::resource, "more than 2^32 references in the cells", what_);
    total_ = grid->lists.references.size();
    meter_.take(grid->lists.bytes());
    return place(*grid, 1, options_.max_growth * static_cast<double>(refs.size()), out);
  }

 private:
  /// A cell whose list is replaced by a grid.
  struct Replaced {
    std::size_t cell;
    std::uint32_t grid;
  };

  /// Writes the grid, then its sub-grids, then its lists. @param words for sub-grids
  std::uint32_t place(const CellGrid& grid, int depth, double words, NestedGrids& out) {
    const auto index = static_cast<std::uint32_t>(out.grids.size());
    const std::size_t count = grid.cells.count(), first = out.first.size();
    meter_.take(kGrowth * (sizeof(NestedGrid) + grid.lists.bytes()));
    out.grids.push_back({grid.cells, first});
    out.first.resize(first + count + 1);
    const std::vector<Replaced> replaced = depth < options_.max_depth
                                               ? divide_cells(grid, depth, words, out)
                                               : std::vector<Replaced>{};
    auto next = replaced.begin();
    for (std::size_t c = 0; c < count; ++c) {
      out.first[first + c] = static_cast<std::uint32_t>(out.entries.size());
      if (next != replaced.end() && next->cell == c) {
        out.entries.push_back(NestedGrids::kGridEntry | next->grid), ++next;
      } else {
        const std::span<const std::uint32_t> list = grid.lists[c];
        out.entries.insert(out.entries.end(), list.begin(), list.end());
      }
    }
    if (out.entries.size() > UINT32_MAX || out.first.size() > UINT32_MAX)
      throw Error(ErrorCode::resource, "more than 2^32 cells or references", what_);
    out.first[first + count] = static_cast<std::uint32_t>(out.entries.size());
    return index;
  }

  std::vector<Replaced> divide_cells(const CellGrid& grid, int depth, double words,
                                     NestedGrids& out) {
    std::vector<std::size_t> crowded;
    double all = 0.0;
    for (std::size_t c = 0; c < grid.cells.count(); ++c) {
      if (grid.lists[c].size() <= static_cast<std::size_t>(options_.max_prims)) continue;
      crowded.push_back(c), all += static_cast<double>(grid.lists[c].size());
    }
    const auto divide = [&](std::size_t begin, std::size_t end, NestedGrids& to) {
      std::vector<Replaced> replaced;
      for (std::size_t i = begin; i < end; ++i) {
        const double share = static_cast<double>(grid.lists[crowded[i]].size()) / all;
        const auto made = divide_cell(grid, crowded[i], depth, words * share, to);
        if (made) replaced.push_back({crowded[i], *made});
      }
      return replaced;
    };
    if (depth > 1 || context_.executor.width() == 1) return divide(0, crowded.size(), out);
    return divide_at_once(crowded.size(), divide, out);
  }

  /// Tasks write to grids of their own, appended in order: the result is that of one task.
  template <class Divide>
  std::vector<Replaced> divide_at_once(std::size_t count, Divide divide, NestedGrids& out) {
    struct Part {
      NestedGrids grids;
      std::vector<Replaced> replaced;
    };
    std::vector<Part> parts((count + kGrain - 1) / kGrain);
    context_.executor.parallel_for(0, count, kGrain, [&](std::size_t begin, std::size_t end) {
      Part& part = parts[begin / kGrain];
      part.replaced = divide(begin, end, part.grids);
    });
    std::vector<Replaced> replaced;
    for (Part& part : parts) {
      const auto base = static_cast<std::uint32_t>(out.grids.size());
      out.append(part.grids, what_);
      for (const Replaced& r : part.replaced) replaced.push_back({r.cell, base + r.grid});
      part = {};
    }
    return replaced;
  }

  /// Empty where no grid fits the words or pays.
  std::optional<std::uint32_t> divide_cell(const CellGrid& grid, std::size_t cell, int depth,
                                           double words, NestedGrids& out) {
    const std::span<const std::uint32_t> list = grid.lists[cell];
    report(list.size(), depth);
    if (!(words >= kLeastWords)) return {};
    const Aabb box = grid.cells.box(grid.cells.position(cell));
    const MemoryLease lease(meter_, list.size() * sizeof(PrimRef));
    const auto sub = divide_box(box, list, words);
    if (!sub) return {};
    const MemoryLease lists(meter_, sub->lists.bytes());
    const double used =
        static_cast<double>(kHeaderWords + sub->lists.first.size() + sub->lists.references.size());
    return place(*sub, depth + 1, words - used, out);
  }

  std::optional<CellGrid> divide_box(const Aabb& box, std::span<const std::uint32_t> list,
                                     double words) {
    const std::vector<PrimRef> parts = nested_parts(input_.source, box, list, input_.exact);
    constexpr double kMost = 1 << 30;
    CellGridOptions options = sub_;
    options.max_cells = static_cast<int>(std::min(kMost, 0.25 * words));
    const auto most = static_cast<std::uint64_t>(std::min(kMost, 0.5 * words));
    auto sub = fit({input_.source, parts, input_.exact, most}, box, options);
    if (!sub || sub->cells.count() == 1) return {};
    const double cost = kEnterCost + report_of(*sub).sah_cost;
    if (options_.decide == NestingDecision::cost && !(cost < static_cast<double>(list.size())))
      return {};
    return sub;
  }

  std::optional<CellGrid> fit(const CellListInput& input, const Aabb& box,
                              const CellGridOptions& options) const {
    const BuildContext& context = input.refs.size() < kReportEvery ? quiet_ : context_;
    return fit_cell_grid(input, box, options, meter_.bytes(), context);
  }

  /// Asks whether to go on, now and then; told are the references of the outermost grid.
  void report(std::size_t references, int depth) {
    if (depth == 1) done_.fetch_add(references, std::memory_order_relaxed);
    const std::size_t before = seen_.fetch_add(references, std::memory_order_relaxed);
    if (before > 0 && before / kReportEvery == (before + references) / kReportEvery) return;
    const auto done = static_cast<double>(done_.load(std::memory_order_relaxed));
    context_.check(std::min(1.0, done / static_cast<double>(total_)), "dividing cells");
  }

  const NestedGridInput& input_;
  const NestingOptions& options_;
  const BuildContext& context_;
  const char* what_;
  CellGridOptions sub_;
  MemoryMeter meter_;
  BuildContext quiet_;  ///< for grids too small to be told of
  std::size_t total_ = 0;
  std::atomic<std::size_t> done_{0}, seen_{0};
};

}  // namespace

std::vector<PrimRef> nested_parts(const PrimitiveSource& source, const Aabb& box,
                                  std::span<const std::uint32_t> list, bool exact) {
  std::vector<PrimRef> parts;
  parts.reserve(list.size());
  for (const std::uint32_t i : list) {
    const Aabb part = Aabb::intersection(exact ? source.clip(i, box) : source.bounds(i), box);
    if (!part.is_empty()) parts.push_back({part, i});
  }
  return parts;
}

void require_entries(const PrimitiveSource& source, const char* what) {
  if (source.size() >= NestedGrids::kGridEntry)
    throw Error(ErrorCode::resource, "more than 2^31 primitives", what);
}

Aabb NestedGrids::box(std::uint32_t grid) const {
  const UniformCells& of = cells(grid);
  return Aabb::join(of.box({0, 0, 0}), of.box({of.n(0) - 1, of.n(1) - 1, of.n(2) - 1}));
}

std::uint64_t NestedGrids::bytes() const {
  return grids.capacity() * sizeof(NestedGrid) +
         (first.capacity() + entries.capacity()) * sizeof(std::uint32_t);
}

void NestedGrids::append(const NestedGrids& more, const char* what) {
  const std::size_t grid = grids.size(), cell = first.size(), entry = entries.size();
  if (grid + more.grids.size() > kGridEntry || entry + more.entries.size() > UINT32_MAX)
    throw Error(ErrorCode::resource, "more than 2^31 grids or 2^32 references", what);
  for (const NestedGrid& g : more.grids) grids.push_back({g.cells, g.first + cell});
  for (const std::uint32_t f : more.first) first.push_back(f + static_cast<std::uint32_t>(entry));
  for (const std::uint32_t e : more.entries)
    entries.push_back(is_grid(e) ? e + static_cast<std::uint32_t>(grid) : e);
}

std::uint32_t add_nested_grid(const NestedGridInput& input, const CellGridOptions& options,
                              const NestingOptions& nesting, const BuildContext& context,
                              const char* what, NestedGrids& out) {
  return NestedGridBuilder(input, nesting, context, what).run(options, out);
}

}  // namespace strahl
