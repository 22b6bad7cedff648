#include <numeric>
#include <thread>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/ray_classification/cell_cache.h>

namespace strahl {
namespace {

/// The list that a path of children stands for: what a filter would make of it.
std::vector<std::uint32_t> list_of(const std::vector<unsigned>& path) {
  std::uint32_t sum = 7;
  for (const unsigned number : path) sum = sum * 33 + number;
  return std::vector<std::uint32_t>(20 + sum % 50, sum);
}

const std::vector<std::uint32_t> kRootList(200, 1);

/// Walks random paths to a fixed depth, adding what is missing, and checks every list it meets.
void walk_paths(CellCache& cache, std::uint64_t seed, int rays, unsigned fan, std::size_t depth) {
  Rng rng(seed);
  for (int i = 0; i < rays; ++i) {
    const Epochs::Reader reading = cache.reader();
    CellCache::Cell* cell = &cache.root(0);
    std::vector<unsigned> path;
    while (path.size() < depth) {
      path.push_back(rng.below(fan));
      CellCache::Cell* child = cell->child(path.back());
      if (child == nullptr && cache.wants(*cell, path.back()))
        child = cache.add(*cell, path.back(), list_of(path));
      if (child == nullptr) break;
      const std::vector<std::uint32_t> expected = list_of(path);
      ASSERT_TRUE(
          std::equal(expected.begin(), expected.end(), child->list().begin(), child->list().end()));
      cell = child;
    }
    cache.touch(*cell);
    ASSERT_LE(cache.figures().bytes, cache.budget());
  }
}

TEST(CellCache, KeepsWhatFitsAndCountsIt) {
  CellCache cache({kRootList}, 1 << 20, 1);
  walk_paths(cache, 1, 2000, 4, 3);
  const CellCache::Figures figures = cache.figures();
  EXPECT_EQ(figures.added, 4u + 16 + 64);
  EXPECT_EQ(figures.evicted, 0u);
  EXPECT_EQ(figures.refused, 0u);
  EXPECT_EQ(figures.bytes, cache.count_bytes());
}

TEST(CellCache, StaysWithinItsBudgetWhileItEvicts) {
  for (const std::uint64_t budget : {3000u, 10000u, 60000u}) {
    CellCache cache({kRootList}, budget, 1);
    walk_paths(cache, budget, 4000, 16, 3);
    const CellCache::Figures figures = cache.figures();
    EXPECT_GT(figures.evicted, 100u) << budget;
    EXPECT_LE(figures.bytes, budget);
    EXPECT_EQ(figures.bytes, cache.count_bytes());
  }
}

TEST(CellCache, WithoutABudgetNothingIsAdded) {
  for (const std::uint64_t budget : {0u, 100u}) {
    CellCache cache({kRootList}, budget, 1);
    walk_paths(cache, 1, 100, 4, 3);
    EXPECT_EQ(cache.figures().added, 0u);
    EXPECT_EQ(cache.figures().refused, 100u);
    EXPECT_EQ(cache.figures().bytes, 0u);
  }
}

TEST(CellCache, ACellIsMadeForTheRayThatExhaustsThePatience) {
  CellCache cache({kRootList}, 1 << 20, 3);
  const Epochs::Reader reading = cache.reader();
  CellCache::Cell& root = cache.root(0);
  EXPECT_FALSE(cache.wants(root, 5));
  EXPECT_FALSE(cache.wants(root, 6));
  EXPECT_FALSE(cache.wants(root, 5));
  EXPECT_TRUE(cache.wants(root, 5));
  EXPECT_FALSE(cache.wants(root, 6));
}

TEST(CellCache, ThoseUsedLongestAgoGoFirst) {
  const std::vector<std::uint32_t> list(200, 3);
  // Room for the table of the root and ten cells.
  const std::uint64_t cell = sizeof(CellCache::Cell) + 800;
  CellCache cache({kRootList}, sizeof(CellCache::Children) + 10 * cell, 1);
  const auto add = [&](unsigned number) {
    const Epochs::Reader reading = cache.reader();
    CellCache::Cell& root = cache.root(0);
    if (!cache.wants(root, number)) return false;
    CellCache::Cell* made = cache.add(root, number, list);
    if (made != nullptr) cache.touch(*made);
    return made != nullptr;
  };
  for (unsigned i = 0; i < 10; ++i) ASSERT_TRUE(add(i));
  {
    const Epochs::Reader reading = cache.reader();
    cache.touch(*cache.root(0).child(0));
    cache.touch(*cache.root(0).child(4));
  }
  for (int i = 0; i < 3; ++i) add(20);  // the ray that evicts cannot use what it frees
  EXPECT_NE(cache.root(0).child(20), nullptr);
  EXPECT_NE(cache.root(0).child(0), nullptr);
  EXPECT_NE(cache.root(0).child(4), nullptr);
  EXPECT_EQ(cache.root(0).child(1), nullptr);
  EXPECT_EQ(cache.root(0).child(2), nullptr);
}

TEST(CellCache, WhatAReaderHasSeenStaysWhileItReads) {
  CellCache cache({kRootList}, 6000, 1);
  walk_paths(cache, 1, 50, 8, 2);
  const Epochs::Reader reading = cache.reader();
  std::vector<const CellCache::Cell*> seen;
  std::vector<std::vector<std::uint32_t>> lists;
  for (unsigned i = 0; i < 8; ++i)
    if (const CellCache::Cell* cell = cache.root(0).child(i)) {
      seen.push_back(cell);
      lists.emplace_back(cell->list().begin(), cell->list().end());
    }
  ASSERT_FALSE(seen.empty());
  std::thread other([&] { walk_paths(cache, 2, 2000, 8, 2); });
  other.join();
  for (std::size_t i = 0; i < seen.size(); ++i)
    EXPECT_TRUE(std::equal(lists[i].begin(), lists[i].end(), seen[i]->list().begin()));
}

TEST(CellCache, ThreadsAddTheSameCellsOnce) {
  CellCache cache({kRootList}, 1 << 22, 2);
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] { walk_paths(cache, t, 3000, 5, 3); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(cache.figures().added, 5u + 25 + 125);
  EXPECT_EQ(cache.figures().bytes, cache.count_bytes());
}

TEST(CellCache, ThreadsEvictAndReadAtOnce) {
  CellCache cache({kRootList}, 40000, 1);
  std::vector<std::thread> threads;
  for (std::uint64_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] { walk_paths(cache, t, 3000, 12, 3); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(cache.figures().evicted, 100u);
  EXPECT_EQ(cache.figures().bytes, cache.count_bytes());
}

TEST(Epochs, NothingSeenIsFreeUntilItsReadersAreGone) {
  Epochs epochs;
  auto first = std::make_unique<Epochs::Reader>(epochs);
  const std::uint64_t unlinked = epochs.now();
  EXPECT_TRUE(epochs.advance());
  EXPECT_FALSE(epochs.advance());
  EXPECT_FALSE(epochs.has_passed(unlinked));
  auto second = std::make_unique<Epochs::Reader>(epochs);  // of the next epoch
  first.reset();
  EXPECT_TRUE(epochs.advance());
  EXPECT_TRUE(epochs.has_passed(unlinked));
  EXPECT_FALSE(epochs.advance());
  second.reset();
  EXPECT_TRUE(epochs.advance());
}

}  // namespace
}  // namespace strahl
