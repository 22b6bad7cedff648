// query/counters.h - the field's work counters as a policy: NoCounters compiles to nothing.
//
// Names after [Havran1999]: N_TS traversal steps, N_ETS leaves (cells) entered, N_EETS empty ones,
// N_BIT bounding volume tests, N_IT primitive tests after mailboxing.
// Thread safety: one object per thread, added up at the end.
#pragma once

#include <cstddef>
#include <cstdint>

namespace strahl {

/// Counts nothing; the machine code is the same as without the calls (checked in CI).
struct NoCounters {
  constexpr void traversal_step() {}
  constexpr void leaf_entered(bool) {}
  constexpr void volume_tests(int) {}
  constexpr void primitive_tested() {}
  constexpr void waiting(std::size_t) {}
};

/// Sums over all rays of a batch, and one maximum.
struct Counters {
  std::uint64_t traversal_steps = 0;   ///< N_TS: inner nodes or cells visited
  std::uint64_t leaves = 0;            ///< N_ETS
  std::uint64_t empty_leaves = 0;      ///< N_EETS
  std::uint64_t bounding_volumes = 0;  ///< N_BIT
  std::uint64_t primitives = 0;        ///< N_IT
  std::uint64_t most_waiting = 0;      ///< largest stack or heap of any ray, where it is counted

  constexpr void traversal_step() { ++traversal_steps; }
  constexpr void leaf_entered(bool is_empty) { ++leaves, empty_leaves += is_empty; }
  constexpr void volume_tests(int n) { bounding_volumes += static_cast<std::uint64_t>(n); }
  constexpr void primitive_tested() { ++primitives; }
  constexpr void waiting(std::size_t n) { most_waiting = n > most_waiting ? n : most_waiting; }

  constexpr Counters& operator+=(const Counters& o) {
    traversal_steps += o.traversal_steps, leaves += o.leaves, empty_leaves += o.empty_leaves;
    bounding_volumes += o.bounding_volumes, primitives += o.primitives;
    waiting(o.most_waiting);
    return *this;
  }
  constexpr bool operator==(const Counters&) const = default;
};

}  // namespace strahl
