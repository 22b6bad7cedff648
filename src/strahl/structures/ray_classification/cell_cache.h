// structures/ray_classification/cell_cache.h - the cells that have lists so far, for any number of
// threads that read them and add to them, within a budget of bytes.
//
// Source: lazy subdivision [ArvoKirk1987].
// Layout: a cell is one block: its header, then its list. A cell that rays wanted to divide has a
//   table of 32 children. Roots are never evicted; their lists belong to somebody else.
// Invariants: a list, once published, never changes and depends only on the path of its cell, so
//   any list on the path of a ray serves it. bytes() never exceeds the budget: bytes are reserved
//   before they are owned, and a cell that has no room is not made.
// Adding: whoever first puts a cell into the table of its parent wins; the others take that one.
//   Nobody waits.
// Evicting: one thread at a time, the others go on without new cells meanwhile. Of the cells
//   without children those used longest ago go first, down to three quarters of the budget. A cell
//   is unlinked at once and freed, with what others have added below it since, when no reader is
//   left that may have seen it (epochs.h); until then it counts.
// Use is told by a clock that ticks with every cell added: while nothing is added, readers find
//   their cells stamped and write nothing.
// Thread safety: const methods need a reader; add() and touch() may be called by any reader.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <strahl/base/function_ref.h>
#include <strahl/structures/ray_classification/epochs.h>
#include <strahl/structures/ray_classification/ray_cell.h>

namespace strahl {

class CellCache {
 public:
  class Cell;

  /// Children of a cell, and how many rays would have liked to go to those that are missing.
  struct Children {
    std::array<std::atomic<Cell*>, RayCell::kChildren> cell{};
    std::array<std::atomic<std::uint8_t>, RayCell::kChildren> wishes{};
  };

  /// A list of groups for the rays of one cell.
  class Cell {
   public:
    std::span<const std::uint32_t> list() const { return {list_, count_}; }
    /// Null where there is none (any more).
    Cell* child(unsigned number) const {
      const Children* children = children_.load(std::memory_order_acquire);
      return children == nullptr ? nullptr : children->cell[number].load(std::memory_order_acquire);
    }
    bool has_children() const;

   private:
    friend class CellCache;
    Cell(const std::uint32_t* list, std::size_t count)
        : list_(list), count_(static_cast<std::uint32_t>(count)) {}

    const std::uint32_t* list_;
    std::uint32_t count_;
    std::atomic<std::uint32_t> last_use_{0};
    std::atomic<Children*> children_{nullptr};
  };

  struct Figures {
    std::uint64_t bytes = 0;    ///< owned now, cells unlinked but not yet free included
    std::uint64_t added = 0;    ///< cells since the beginning
    std::uint64_t evicted = 0;  ///< of them
    std::uint64_t refused = 0;  ///< wishes for which there was no room
  };

  /// @param roots lists of the roots; must outlive it
  /// @param patience rays that want a missing child before it is made, 1..128
  CellCache(const std::vector<std::span<const std::uint32_t>>& roots, std::uint64_t budget,
            int patience);
  ~CellCache();
  CellCache(const CellCache&) = delete;
  CellCache& operator=(const CellCache&) = delete;

  /// What it hands out stays valid as long as the reader lives.
  Epochs::Reader reader() { return Epochs::Reader(epochs_); }
  Cell& root(std::size_t i) const { return *roots_[i]; }
  std::size_t root_count() const { return roots_.size(); }

  /// Told of a ray that wants to go on to a missing child. True when the child should be made.
  bool wants(Cell& parent, unsigned number);
  /// Makes the child unless another thread just has; null when there is no room.
  Cell* add(Cell& parent, unsigned number, std::span<const std::uint32_t> list);
  /// Tells that a ray used the list.
  void touch(Cell& cell) const {
    const std::uint32_t now = clock_.load(std::memory_order_relaxed);
    if (cell.last_use_.load(std::memory_order_relaxed) != now)
      cell.last_use_.store(now, std::memory_order_relaxed);
  }

  std::uint64_t budget() const { return budget_; }
  Figures figures() const;
  /// Bytes of the cells that can be reached and their tables, and of those waiting to be freed.
  /// Equal to figures().bytes while nobody adds.
  std::uint64_t count_bytes();

 private:
  struct Retired {
    Cell* cell;
    std::uint64_t epoch;
  };
  struct Victim {
    Cell* cell;
    Cell* parent;
    unsigned number;
    std::uint32_t last_use;
  };

  static std::uint64_t size_of(std::size_t list) { return sizeof(Cell) + 4 * list; }
  static std::uint64_t size_below(const Cell& cell);
  static Cell* make(std::span<const std::uint32_t> list);
  /// Frees the cell with all below it and returns its bytes.
  static std::uint64_t destroy(Cell* cell);

  bool reserve(std::uint64_t bytes);
  bool reserve_if_free(std::uint64_t bytes);
  Children* children_of(Cell& cell);
  void make_room();
  void free_retired();
  void evict(std::uint64_t excess);
  void find_victims(Cell& cell, std::vector<Victim>& victims);

  std::vector<Cell*> roots_;
  std::uint64_t budget_;
  std::uint8_t patience_;
  Epochs epochs_;
  std::atomic<std::uint64_t> bytes_{0}, added_{0}, evicted_{0}, refused_{0};
  std::atomic<std::uint32_t> clock_{1};
  std::mutex evicting_;           ///< held by the thread that evicts; guards what follows
  std::vector<Retired> retired_;  ///< in the order of their epochs
  std::uint64_t retired_bytes_ = 0;
};

}  // namespace strahl
