#include <algorithm>

#include <strahl/build/space_sweep.h>

namespace strahl {
namespace {

/// Appends the events of fragments [first, size) and sorts them among themselves.
void append_events(std::span<const Fragment> fragments, std::size_t first, std::size_t axis,
                   std::vector<SweepEvent>& events) {
  const auto old = static_cast<std::ptrdiff_t>(events.size());
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
  std::sort(events.begin() + old, events.end());
}

std::vector<SweepEvent> divide_list(const std::vector<SweepEvent>& events, const FragmentHalf& half,
                                    std::size_t axis) {
  std::vector<SweepEvent> kept;
  kept.reserve(2 * half.fragments.size());
  for (SweepEvent event : events) {
    const std::uint32_t place = half.place[event.fragment()];
    if (place == FragmentHalf::kNowhere) continue;
    event.renumber(place);
    kept.push_back(event);
  }
  const auto middle = static_cast<std::ptrdiff_t>(kept.size());
  append_events(half.fragments, half.kept, axis, kept);
  std::inplace_merge(kept.begin(), kept.begin() + middle, kept.end());
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
  for_each_axis(executor, fragments.size(), [&](std::size_t axis) {
    lists[axis].reserve(2 * fragments.size());
    append_events(fragments, 0, axis, lists[axis]);
  });
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
