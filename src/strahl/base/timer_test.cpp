// base/timer_test.cpp - time passes, and starts again.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <strahl/base/timer.h>

namespace strahl {
namespace {

TEST(Timer, GrowsAndStartsAgain) {
  const Timer reference;
  Timer timer;
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_GE(timer.seconds(), 0.002);
  timer.restart();
  const double since_restart = timer.seconds();
  EXPECT_GE(since_restart, 0.0);
  EXPECT_LT(since_restart, reference.seconds());
}

}  // namespace
}  // namespace strahl
