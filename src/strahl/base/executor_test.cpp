// base/executor_test.cpp - chunks, nesting, exceptions and the floating-point environment of tasks.
#include <atomic>
#include <cfenv>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/executor.h>

namespace strahl {
namespace {

using Chunk = std::pair<std::size_t, std::size_t>;

std::set<Chunk> chunks_of(const Executor& executor, std::size_t begin, std::size_t end,
                          std::size_t grain) {
  std::mutex mutex;
  std::set<Chunk> chunks;
  executor.parallel_for(begin, end, grain, [&](std::size_t first, std::size_t last) {
    const std::lock_guard lock(mutex);
    EXPECT_TRUE(chunks.insert({first, last}).second) << "chunk given twice";
  });
  return chunks;
}

std::vector<Executor> executors() {
  std::vector<Executor> all{Executor()};
  if (Executor::threads_available()) {
    all.push_back(Executor::with_threads(2));
    all.push_back(Executor::with_threads(7));
  }
  return all;
}

std::size_t sum_recursively(const Executor& executor, std::size_t begin, std::size_t end) {
  if (end - begin == 1) return begin;
  const std::size_t middle = begin + (end - begin) / 2;
  std::size_t left = 0;
  std::size_t right = 0;
  executor.invoke([&] { left = sum_recursively(executor, begin, middle); },
                  [&] { right = sum_recursively(executor, middle, end); });
  return left + right;
}

TEST(Executor, CutsChunksAtMultiplesOfTheGrainWhateverTheWidth) {
  const std::set<Chunk> expected{{3, 7}, {7, 11}, {11, 13}};
  for (const Executor& executor : executors()) {
    EXPECT_EQ(chunks_of(executor, 3, 13, 4), expected) << "width " << executor.width();
  }
}

TEST(Executor, HandlesEmptyRangesGrainZeroAndTheEndOfTheIndexType) {
  constexpr std::size_t kMax = std::numeric_limits<std::size_t>::max();
  for (const Executor& executor : executors()) {
    EXPECT_TRUE(chunks_of(executor, 5, 5, 1).empty());
    EXPECT_TRUE(chunks_of(executor, 6, 5, 1).empty());
    EXPECT_EQ(chunks_of(executor, 0, 3, 0), (std::set<Chunk>{{0, 1}, {1, 2}, {2, 3}}));
    EXPECT_EQ(chunks_of(executor, kMax - 3, kMax, 2),
              (std::set<Chunk>{{kMax - 3, kMax - 1}, {kMax - 1, kMax}}));
    EXPECT_EQ(chunks_of(executor, 0, 10, kMax), (std::set<Chunk>{{0, 10}}));
  }
}

TEST(Executor, VisitsEveryElementOnce) {
  for (const Executor& executor : executors()) {
    std::vector<std::atomic<int>> visits(10007);
    executor.parallel_for(0, visits.size(), 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++visits[i];
    });
    for (const std::atomic<int>& visit : visits) ASSERT_EQ(visit, 1);
  }
}

TEST(Executor, ForksAndJoinsRecursively) {
  for (const Executor& executor : executors()) {
    EXPECT_EQ(sum_recursively(executor, 0, 5000), 5000u * 4999u / 2);
  }
}

TEST(Executor, NestsParallelLoops) {
  for (const Executor& executor : executors()) {
    std::atomic<int> calls = 0;
    executor.parallel_for(0, 20, 1, [&](std::size_t, std::size_t) {
      executor.parallel_for(0, 30, 1, [&](std::size_t, std::size_t) { ++calls; });
    });
    EXPECT_EQ(calls, 600);
  }
}

TEST(Executor, RethrowsTheExceptionOfATaskToTheCaller) {
  for (const Executor& executor : executors()) {
    const auto fail_at_500 = [](std::size_t first, std::size_t) {
      if (first == 500) throw Error(ErrorCode::cancelled, "at 500");
    };
    try {
      executor.parallel_for(0, 1000, 1, fail_at_500);
      FAIL() << "nothing thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
      EXPECT_STREQ(error.what(), "at 500");
    }
    EXPECT_THROW(executor.invoke([] {}, [] { throw std::runtime_error("second"); }),
                 std::runtime_error);
    EXPECT_THROW(executor.invoke([] { throw std::runtime_error("first"); }, [] {}),
                 std::runtime_error);
  }
}

TEST(Executor, RunsEveryTaskRoundingToNearestAndRestoresTheCaller) {
  for (const Executor& executor : executors()) {
    std::fesetround(FE_DOWNWARD);
    std::atomic<int> wrong = 0;
    const auto check = [&] { wrong += std::fegetround() != FE_TONEAREST; };
    executor.parallel_for(0, 200, 1, [&](std::size_t, std::size_t) { check(); });
    executor.parallel_for(0, 1, 1, [&](std::size_t, std::size_t) { check(); });
    executor.invoke(check, check);
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(wrong, 0) << "width " << executor.width();
    EXPECT_EQ(after, FE_DOWNWARD) << "width " << executor.width();
  }
}

TEST(Executor, IsSerialInOrderByDefaultAndForOneThreadOrLess) {
  for (const Executor& executor :
       {Executor(), Executor::with_threads(1), Executor::with_threads(-3)}) {
    EXPECT_EQ(executor.width(), 1);
    std::vector<std::size_t> order;
    executor.parallel_for(0, 5, 1, [&](std::size_t first, std::size_t) { order.push_back(first); });
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  }
}

TEST(Executor, RefusesAnAbsurdNumberOfThreads) {
  try {
    Executor::with_threads(1000000000);
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("4096"), std::string::npos);
  }
}

TEST(Executor, ReportsItsWidthAndNeverRunsMoreTasksAtOnce) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without oneTBB";
  const Executor executor = Executor::with_threads(2);
  EXPECT_EQ(executor.width(), 2);
  std::atomic<int> running = 0;
  std::atomic<int> most = 0;
  executor.parallel_for(0, 2000, 1, [&](std::size_t, std::size_t) {
    const int now = ++running;
    int seen = most;
    while (seen < now && !most.compare_exchange_weak(seen, now)) {
    }
    --running;
  });
  EXPECT_LE(most, 2);
}

TEST(Executor, RefusesThreadsWithoutTbb) {
  if (Executor::threads_available()) GTEST_SKIP() << "built with oneTBB";
  try {
    Executor::with_threads(2);
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unsupported);
  }
}

}  // namespace
}  // namespace strahl
