#include <algorithm>

#include <strahl/build/space_sweep.h>

namespace strahl {
namespace {

/// The sorted events of fragments [first, size).
std::vector<SweepEvent> sorted_events(std::span<const Fragment> fragments, std::size_t first,
                                      std::size_t axis) {
  std::vector<SweepEvent> events;
  events.reserve(2 * (fragments.size() - first));
  for (std::size_t i = first; i < fragments.size(); ++i) {
    const Fragment& f = fragments[i];
    const auto index = static_cast<std::uint32_t>(i);
    if (f.is_planar(axis)) {
      events.emplace_back(f.lo[axis], index, SweepEvent::planar);
    } else {
      events.emplace_back(f.lo[axis], index, SweepEvent::start);
      events.emplace_back(f.hi[axis], index, SweepEvent::end);
    }
  }
  std::sort(events.begin(), events.end());
  return events;
}

/// Merges sorted events into the sorted first `count` of a list, from behind and within it: its
/// size is that of both together.
void merge_into(std::vector<SweepEvent>& list, std::size_t count,
                const std::vector<SweepEvent>& more) {
  std::size_t left = more.size();
  while (left > 0) {
    const bool is_old = count > 0 && more[left - 1] < list[count - 1];
    const std::size_t to = count + left - 1;
    list[to] = is_old ? list[--count] : more[--left];
  }
}

std::vector<SweepEvent> divide_list(const std::vector<SweepEvent>& events, const FragmentHalf& half,
                                    std::size_t axis) {
  const std::vector<SweepEvent> more = sorted_events(half.fragments, half.kept, axis);
  // No branch per event: which ones stay follows no order that a processor could predict. One
  // element more than stay is written to.
  std::vector<SweepEvent> kept(2 * half.kept + more.size() + 1, {0.0f, 0, SweepEvent::end});
  std::size_t count = 0;
  for (SweepEvent event : events) {
    const std::uint32_t place = half.place[event.fragment()];
    event.renumber(place);
    kept[count] = event;
    count += place != FragmentHalf::kNowhere;
  }
  kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(count + more.size()), kept.end());
  merge_into(kept, count, more);
  return kept;
}

SplitPlane best_end(std::span<const SweepEvent> events, std::size_t fragments,
                    const PlaneCost& cost, std::size_t axis) {
  SplitPlane best;
  for_each_sweep_plane(events, fragments, [&](float position, const PlaneCounts& counts) {
    cost.offer(axis, position, counts, best);
  });
  return best;
}

}  // namespace

SweepLists make_sweep_lists(std::span<const Fragment> fragments, const Executor& executor) {
  SweepLists lists;
  for_each_axis(executor, fragments.size(),
                [&](std::size_t axis) { lists[axis] = sorted_events(fragments, 0, axis); });
  return lists;
}

SweepLists divide_sweep_lists(const SweepLists& lists, const FragmentHalf& half,
                              const Executor& executor) {
  SweepLists divided;
  for_each_axis(executor, half.place.size(),
                [&](std::size_t axis) { divided[axis] = divide_list(lists[axis], half, axis); });
  return divided;
}

SplitPlane find_plane_by_sweep(const SweepLists& lists, std::size_t fragments,
                               const PlaneCost& cost, const Executor& executor) {
  std::array<SplitPlane, 3> best;
  for_each_axis(executor, fragments, [&](std::size_t axis) {
    best[axis] = best_end(lists[axis], fragments, cost, axis);
  });
  return cheapest(best);
}

void offer_ends(const SweepLists& lists, std::size_t fragments, PlaneSlices& slices,
                const Executor& executor) {
  for_each_axis(executor, fragments, [&](std::size_t axis) {
    for_each_sweep_plane(lists[axis], fragments, [&](float position, const PlaneCounts& counts) {
      slices.offer(axis, position, counts);
    });
  });
}

}  // namespace strahl
