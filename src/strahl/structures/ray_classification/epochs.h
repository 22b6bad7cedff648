// structures/ray_classification/epochs.h - tells when what readers may have seen can be freed.
//
// Source: epoch-based reclamation [Fraser2004], with counters of readers instead of a slot for
//   each thread, so that threads need not be known.
// Invariants: the epoch goes from e to e + 1 only when no reader of e - 1 is left, so readers are
//   of e and e - 1. What was unlinked in epoch r was seen at most by readers of r and before: from
//   r + 2 on nobody has it.
//   A reader counts itself, then looks whether the epoch is still the one it counted for; if it is,
//   whoever advances the epoch later finds the count (all sequentially consistent).
// Costs a reader two additions to a counter that few threads share; never waits for a writer.
// Thread safety: Readers from any number of threads; advance() from one at a time.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

namespace strahl {

class Epochs {
 public:
  /// Counts as a reader during its life. The same thread may have several.
  class Reader {
   public:
    explicit Reader(Epochs& epochs) : count_(epochs.enter()) {}
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { count_.fetch_sub(1); }

   private:
    std::atomic<std::uint64_t>& count_;
  };

  std::uint64_t now() const { return epoch_.load(); }
  /// Goes one on if no reader of the epoch before is left.
  bool advance() {
    const std::uint64_t epoch = epoch_.load();
    for (const Shard& shard : shards_)
      if (shard.readers[(epoch + 1) % 2].load() != 0) return false;
    epoch_.store(epoch + 1);
    return true;
  }
  /// Whether something unlinked when now() was `epoch` can be freed.
  bool has_passed(std::uint64_t epoch) const { return epoch_.load() >= epoch + 2; }

 private:
  static constexpr std::size_t kShards = 32;
  /// Even and odd epochs; a cache line pair of its own.
  struct alignas(128) Shard {
    std::array<std::atomic<std::uint64_t>, 2> readers{};
  };

  std::atomic<std::uint64_t>& enter() {
    // Addresses of thread control blocks differ in their middle bits.
    const std::uint64_t id = std::hash<std::thread::id>{}(std::this_thread::get_id());
    Shard& shard = shards_[id * 0x9e3779b97f4a7c15u >> 59];
    for (;;) {
      const std::uint64_t epoch = epoch_.load();
      std::atomic<std::uint64_t>& count = shard.readers[epoch % 2];
      count.fetch_add(1);
      if (epoch_.load() == epoch) return count;
      count.fetch_sub(1);
    }
  }

  std::array<Shard, kShards> shards_;
  std::atomic<std::uint64_t> epoch_{2};
};

}  // namespace strahl
