#include <algorithm>
#include <new>

#include <strahl/structures/ray_classification/cell_cache.h>

namespace strahl {

bool CellCache::Cell::has_children() const {
  const Children* children = children_.load(std::memory_order_acquire);
  if (children == nullptr) return false;
  return std::any_of(children->cell.begin(), children->cell.end(), [](const auto& child) {
    return child.load(std::memory_order_relaxed) != nullptr;
  });
}

CellCache::CellCache(const std::vector<std::span<const std::uint32_t>>& roots, std::uint64_t budget,
                     int patience)
    : budget_(budget), patience_(static_cast<std::uint8_t>(patience)) {
  for (const auto& list : roots)
    roots_.push_back(new (::operator new(sizeof(Cell))) Cell(list.data(), list.size()));
}

CellCache::~CellCache() {
  for (Cell* root : roots_) destroy(root);
  for (const Retired& retired : retired_) destroy(retired.cell);
}

CellCache::Cell* CellCache::make(std::span<const std::uint32_t> list) {
  static_assert(sizeof(Cell) % alignof(std::uint32_t) == 0);
  void* block = ::operator new(size_of(list.size()));
  auto* own = reinterpret_cast<std::uint32_t*>(static_cast<std::byte*>(block) + sizeof(Cell));
  std::copy(list.begin(), list.end(), own);
  return new (block) Cell(own, list.size());
}

std::uint64_t CellCache::destroy(Cell* cell) {
  std::uint64_t bytes = size_of(cell->count_);
  if (Children* children = cell->children_.load()) {
    bytes += sizeof(Children);
    for (const auto& child : children->cell)
      if (Cell* below = child.load()) bytes += destroy(below);
    delete children;
  }
  cell->~Cell();
  ::operator delete(cell);
  return bytes;
}

std::uint64_t CellCache::size_below(const Cell& cell) {
  const Children* children = cell.children_.load(std::memory_order_acquire);
  if (children == nullptr) return 0;
  std::uint64_t bytes = sizeof(Children);
  for (unsigned i = 0; i < RayCell::kChildren; ++i)
    if (const Cell* child = cell.child(i)) bytes += size_of(child->count_) + size_below(*child);
  return bytes;
}

bool CellCache::reserve_if_free(std::uint64_t bytes) {
  std::uint64_t owned = bytes_.load(std::memory_order_relaxed);
  do {
    if (bytes > budget_ - owned) return false;
  } while (!bytes_.compare_exchange_weak(owned, owned + bytes));
  return true;
}

/// A list that fills most of the budget by itself would only push out everything else.
bool CellCache::reserve(std::uint64_t bytes) {
  if (reserve_if_free(bytes)) return true;
  if (bytes <= budget_ / 4) {
    make_room();
    if (reserve_if_free(bytes)) return true;
  }
  refused_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

CellCache::Children* CellCache::children_of(Cell& cell) {
  Children* children = cell.children_.load(std::memory_order_acquire);
  if (children != nullptr) return children;
  if (!reserve(sizeof(Children))) return nullptr;
  auto made = std::make_unique<Children>();
  if (cell.children_.compare_exchange_strong(children, made.get())) return made.release();
  bytes_.fetch_sub(sizeof(Children));
  return children;
}

bool CellCache::wants(Cell& parent, unsigned number) {
  Children* children = children_of(parent);
  if (children == nullptr) return false;
  std::atomic<std::uint8_t>& wishes = children->wishes[number];
  if (wishes.load(std::memory_order_relaxed) + 1 < patience_)
    return wishes.fetch_add(1, std::memory_order_relaxed) + 1 >= patience_;
  return true;
}

CellCache::Cell* CellCache::add(Cell& parent, unsigned number,
                                std::span<const std::uint32_t> list) {
  Children& children = *parent.children_.load(std::memory_order_acquire);
  children.wishes[number].store(0, std::memory_order_relaxed);
  const std::uint64_t bytes = size_of(list.size());
  if (!reserve(bytes)) return nullptr;
  Cell* made = make(list);
  Cell* other = nullptr;
  if (!children.cell[number].compare_exchange_strong(other, made)) {
    destroy(made);
    bytes_.fetch_sub(bytes);
    return other;
  }
  added_.fetch_add(1, std::memory_order_relaxed);
  clock_.fetch_add(1, std::memory_order_relaxed);
  return made;
}

void CellCache::make_room() {
  const std::unique_lock lock(evicting_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  free_retired();
  const std::uint64_t live = bytes_.load() - retired_bytes_, wanted = budget_ / 4 * 3;
  if (live > wanted) evict(live - wanted);
  free_retired();
}

/// Needs evicting_. The caller is a reader itself, so what it unlinks now it frees later.
void CellCache::free_retired() {
  if (!retired_.empty() && epochs_.advance()) epochs_.advance();
  std::size_t free = 0;
  while (free < retired_.size() && epochs_.has_passed(retired_[free].epoch)) ++free;
  for (std::size_t i = 0; i < free; ++i) {
    const std::uint64_t bytes = destroy(retired_[i].cell);
    bytes_.fetch_sub(bytes);
  }
  retired_.erase(retired_.begin(), retired_.begin() + static_cast<std::ptrdiff_t>(free));
  retired_bytes_ = 0;
  for (const Retired& retired : retired_)
    retired_bytes_ += size_of(retired.cell->count_) + size_below(*retired.cell);
}

void CellCache::find_victims(Cell& cell, std::vector<Victim>& victims) {
  for (unsigned i = 0; i < RayCell::kChildren; ++i) {
    Cell* child = cell.child(i);
    if (child == nullptr) continue;
    if (child->has_children())
      find_victims(*child, victims);
    else
      victims.push_back({child, &cell, i, child->last_use_.load(std::memory_order_relaxed)});
  }
}

/// Unlinks cells of at least `excess` bytes, oldest first; needs evicting_.
void CellCache::evict(std::uint64_t excess) {
  std::vector<Victim> victims;
  for (Cell* root : roots_) find_victims(*root, victims);
  std::stable_sort(victims.begin(), victims.end(),
                   [](const Victim& a, const Victim& b) { return a.last_use < b.last_use; });
  std::uint64_t unlinked = 0;
  for (const Victim& v : victims) {
    if (unlinked >= excess) return;
    Children& siblings = *v.parent->children_.load(std::memory_order_acquire);
    siblings.cell[v.number].store(nullptr);
    // A parent left without children was used when its last child was.
    if (v.parent->last_use_.load(std::memory_order_relaxed) < v.last_use)
      v.parent->last_use_.store(v.last_use, std::memory_order_relaxed);
    const std::uint64_t bytes = size_of(v.cell->count_) + size_below(*v.cell);
    retired_.push_back({v.cell, epochs_.now()});
    retired_bytes_ += bytes;
    unlinked += bytes;
    evicted_.fetch_add(1, std::memory_order_relaxed);
  }
}

CellCache::Figures CellCache::figures() const {
  return {bytes_.load(), added_.load(), evicted_.load(), refused_.load()};
}

std::uint64_t CellCache::count_bytes() {
  const Epochs::Reader reading = reader();
  const std::lock_guard lock(evicting_);
  std::uint64_t sum = 0;
  for (const Cell* root : roots_) sum += size_below(*root);
  for (const Retired& retired : retired_)
    sum += size_of(retired.cell->count_) + size_below(*retired.cell);
  return sum;
}

}  // namespace strahl
