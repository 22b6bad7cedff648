// traverse/mailbox.h - remembers which references a ray has met, so that most are tested once.
//
// Source: [AmanatidesWoo1987] for the idea; a small table per ray instead of a stamp per primitive
//   ([Benthin2006]), so threads share nothing. Each reference has one slot; a newcomer takes it, so
//   a reference may be tested again but none is ever missed, and what it offered the query stays.
// Layout: a bit per slot says whether it is in use, so a ray clears 128 bytes, not 4 KB. Slots
//   outnumber the references of a crowded cell: lists ascend, so fewer slots than references would
//   forget each one before the next cell asks for it.
// Thread safety: one mailbox per ray, on its stack.
#pragma once

#include <array>
#include <cstdint>

#include <strahl/math/ray.h>

namespace strahl {

/// The references met last, at most one per slot. @tparam kSlots a multiple of 64
template <std::uint32_t kSlots>
class SlotMailbox {
 public:
  SlotMailbox() { used_.fill(0); }
  /// Whether the reference has to be tested: it is not known to have been admitted before.
  bool admit(std::uint32_t reference) {
    const std::uint32_t slot = reference % kSlots;
    std::uint64_t& word = used_[slot / 64];
    const std::uint64_t bit = std::uint64_t{1} << slot % 64;
    if ((word & bit) != 0 && slots_[slot] == reference) return false;
    word |= bit, slots_[slot] = reference;
    return true;
  }

 private:
  std::array<std::uint64_t, kSlots / 64> used_;
  std::array<std::uint32_t, kSlots> slots_;  // read only where used_ says so
};

/// For primitives.
class Mailbox : public SlotMailbox<1024> {
 public:
  static constexpr std::uint32_t kSlots = 1024;
};

/// Primitives behind a mailbox; takes the place of Prims for one ray.
template <class Prims>
class MailedPrims {
 public:
  explicit MailedPrims(Prims& prims) : prims_(prims) {}

  template <class Q, class C>
  bool visit(std::uint32_t reference, const PreparedRay& ray, Q& query, C& counters) {
    return mailbox_.admit(reference) && prims_.visit(reference, ray, query, counters);
  }

 private:
  Prims& prims_;
  Mailbox mailbox_;
};

}  // namespace strahl
