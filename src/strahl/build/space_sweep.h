// build/space_sweep.h - split planes by an exact sweep over sorted ends of fragments.
//
// Source: [WaldHavran2006], section 4.3. Events are sorted once per axis; dividing a node keeps
//   what the plane does not cut in order and sorts only the events of cut fragments, so a tree of
//   n fragments costs O(n log n) as long as planes cut few.
// Layout: one list per axis of 8-byte events; a fragment has an end and a start, or one planar
//   event where it has no extent.
// Invariants: lists are sorted by (position, end < planar < start).
// Thread safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/base/executor.h>
#include <strahl/build/space_slices.h>

namespace strahl {

/// Fragments that one node's events can number.
inline constexpr std::size_t kMaxSweepFragments = std::size_t{1} << 30;

/// An end of a fragment on one axis.
struct SweepEvent {
  enum Kind : std::uint32_t { end, planar, start };

  SweepEvent(float at, std::uint32_t fragment, Kind kind)
      : position(at), packed(fragment << 2 | kind) {}

  float position;
  std::uint32_t packed;  ///< fragment index and kind

  std::uint32_t fragment() const { return packed >> 2; }
  Kind kind() const { return static_cast<Kind>(packed & 3u); }
  void renumber(std::uint32_t fragment) { packed = fragment << 2 | (packed & 3u); }
  bool operator<(const SweepEvent& o) const {
    return position < o.position || (position == o.position && kind() < o.kind());
  }
};
static_assert(sizeof(SweepEvent) == 8);

using SweepLists = std::array<std::vector<SweepEvent>, 3>;

/// Bytes of events per fragment when none is planar.
inline constexpr std::size_t kSweepBytesPerFragment = 6 * sizeof(SweepEvent);

/// Sorted events of all axes. Requires: at most kMaxSweepFragments. O(n log n).
SweepLists make_sweep_lists(std::span<const Fragment> fragments, const Executor& executor);

/// Events of one half of a divided node. O(n + m log m), m cut fragments.
SweepLists divide_sweep_lists(const SweepLists& lists, const FragmentHalf& half,
                              const Executor& executor);

/// Calls visit(position, PlaneCounts) for each distinct position of one axis, ascending. O(n).
template <class Visit>
void for_each_sweep_plane(std::span<const SweepEvent> events, std::size_t fragments, Visit visit) {
  PlaneCounts counts{0, 0, fragments};
  for (std::size_t i = 0; i < events.size();) {
    const float position = events[i].position;
    const std::size_t first = i;
    std::size_t ends = 0, starts = 0;
    for (; i < events.size() && events[i].position == position; ++i) {
      ends += events[i].kind() == SweepEvent::end;
      starts += events[i].kind() == SweepEvent::start;
    }
    counts.planar = i - first - ends - starts;
    counts.right -= ends + counts.planar;
    visit(position, counts);
    counts.left += starts + counts.planar;
  }
}

/// The cheapest plane through an end of any fragment, strictly inside the cell; is_found() is false
/// when there is none. Ties: lowest axis, then position. O(n).
SplitPlane find_plane_by_sweep(const SweepLists& lists, std::size_t fragments,
                               const PlaneCost& cost, const Executor& executor);

/// The cheapest plane through an end of any fragment for every slice. O(n).
void offer_ends(const SweepLists& lists, std::size_t fragments, PlaneSlices& slices,
                const Executor& executor);

}  // namespace strahl
