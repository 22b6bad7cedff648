// base/build_context_test.cpp - cancelling, serialised progress and the memory limit.
#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/build_context.h>

namespace strahl {
namespace {

TEST(BuildContext, GoesOnWithoutACallback) {
  const BuildContext context;
  EXPECT_NO_THROW(context.check(0.5, "splitting"));
  EXPECT_NO_THROW(context.require_memory(UINT64_MAX, "nodes"));
}

TEST(BuildContext, PassesFractionAndStageToTheCallback) {
  BuildContext context;
  std::vector<std::string> calls;
  context.progress = [&](double fraction, std::string_view stage) {
    calls.push_back(std::string(stage) + " " + std::to_string(fraction));
    return true;
  };
  context.check(0.25, "binning");
  EXPECT_EQ(calls, (std::vector<std::string>{"binning 0.250000"}));
}

TEST(BuildContext, ThrowsCancelledWhenTheCallbackSaysNo) {
  BuildContext context;
  context.progress = [](double fraction, std::string_view) { return fraction < 0.5; };
  EXPECT_NO_THROW(context.check(0.4, "sorting"));
  try {
    context.check(0.5, "sorting");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
    EXPECT_STREQ(error.what(), "sorting: cancelled");
  }
}

TEST(BuildContext, NamesBothNumbersWhenMemoryIsShort) {
  BuildContext context;
  context.memory_limit = 1000;
  EXPECT_NO_THROW(context.require_memory(1000, "kd_tree"));
  try {
    context.require_memory(1001, "kd_tree");
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource);
    EXPECT_STREQ(error.what(), "kd_tree: needs 1001 bytes, the memory limit is 1000");
  }
}

TEST(BuildContext, NeverRunsTheCallbackTwiceAtOnceEvenFromCopies) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without oneTBB";
  BuildContext context;
  context.executor = Executor::with_threads(4);
  std::atomic<int> inside = 0;
  std::atomic<int> overlaps = 0;
  int calls = 0;
  context.progress = [&](double, std::string_view) {
    ++inside;
    std::this_thread::yield();  // gives another thread every chance to come in
    if (inside > 1) ++overlaps;
    ++calls;
    --inside;
    return true;
  };
  const BuildContext copy = context;
  context.executor.parallel_for(
      0, 20000, 1, [&](std::size_t i, std::size_t) { (i % 2 ? context : copy).check(0, "loop"); });
  EXPECT_EQ(calls, 20000);
  EXPECT_EQ(overlaps, 0);
}

TEST(BuildContext, CancelsAParallelLoop) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without oneTBB";
  BuildContext context;
  context.executor = Executor::with_threads(2);
  context.progress = [calls = 0](double, std::string_view) mutable { return ++calls < 10; };
  std::atomic<int> done = 0;
  const auto body = [&](std::size_t, std::size_t) {
    context.check(0, "loop");
    ++done;
  };
  EXPECT_THROW(context.executor.parallel_for(0, 100000, 1, body), Error);
  EXPECT_LT(done, 100000);
}

}  // namespace
}  // namespace strahl
