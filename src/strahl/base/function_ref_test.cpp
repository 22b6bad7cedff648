// base/function_ref_test.cpp - function_ref calls what it was given, in place.
#include <memory>

#include <gtest/gtest.h>

#include <strahl/base/function_ref.h>

namespace strahl {
namespace {

int twice(int x) { return 2 * x; }

int apply(function_ref<int(int)> f, int x) { return f(x); }

TEST(FunctionRef, CallsALambdaWithItsCapture) {
  const int offset = 5;
  EXPECT_EQ(apply([&](int x) { return x + offset; }, 2), 7);
}

TEST(FunctionRef, CallsAPlainFunction) {
  EXPECT_EQ(apply(twice, 21), 42);
  EXPECT_EQ(apply(&twice, 21), 42);
}

TEST(FunctionRef, ChangesTheStateOfTheCallableItself) {
  int calls = 0;
  auto count = [calls]() mutable { return ++calls; };
  const function_ref<int()> ref = count;
  ref();
  EXPECT_EQ(ref(), 2);
  EXPECT_EQ(count(), 3);
}

TEST(FunctionRef, CopiesReferToTheSameCallable) {
  int calls = 0;
  auto count = [&] { ++calls; };
  const function_ref<void()> first = count;
  const function_ref<void()> second = first;
  first();
  second();
  EXPECT_EQ(calls, 2);
}

TEST(FunctionRef, PassesMoveOnlyArgumentsThrough) {
  auto take = [](std::unique_ptr<int> p) { return *p; };
  const function_ref<int(std::unique_ptr<int>)> ref = take;
  EXPECT_EQ(ref(std::make_unique<int>(9)), 9);
}

}  // namespace
}  // namespace strahl
