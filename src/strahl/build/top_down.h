// build/top_down.h - the one recursion of all top-down builders.
//
// A policy knows what a node's work is, whether to divide it and what to write. The loop decides
// order and parallelism. Output is written depth first, left before right; a forked right half
// goes to its own output and is appended afterwards, so the result never depends on threads.
// Policy: using Work, Output;
//   std::optional<Split> plan(Work&, int depth)       empty: make a leaf
//   void leaf(Work&&, Output&)
//   std::size_t open(const Work&, const Split&, Output&)   writes an inner node, returns its index
//   std::pair<Work, Work> divide(Work&&, const Split&)
//   void link(Output&, std::size_t inner)             the next node written is inner's right child
//   void append(Output&, Output&&)                    joins a forked right half, shifting indices
//   std::size_t weight(const Work&)                   primitives, for forking and progress
//   Output make_output() const
#pragma once

#include <atomic>
#include <cstddef>
#include <utility>

#include <strahl/base/build_context.h>

namespace strahl {

/// Runs a policy to the end. Work below kForkWeight stays on one thread.
template <class Policy>
class TopDown {
 public:
  TopDown(Policy& policy, const BuildContext& context, std::size_t total)
      : policy_(policy), context_(context), total_(total) {}

  void run(typename Policy::Work work, typename Policy::Output& out) {
    recurse(std::move(work), 0, out);
  }

 private:
  static constexpr std::size_t kForkWeight = 4096;

  void recurse(typename Policy::Work work, int depth, typename Policy::Output& out) {
    const auto split = policy_.plan(work, depth);
    if (!split) {
      report(policy_.weight(work));
      policy_.leaf(std::move(work), out);
      return;
    }
    const std::size_t inner = policy_.open(work, *split, out);
    const bool fork = context_.executor.width() > 1 && policy_.weight(work) >= kForkWeight;
    auto parts = policy_.divide(std::move(work), *split);
    if (!fork) {
      recurse(std::move(parts.first), depth + 1, out);
      policy_.link(out, inner);
      recurse(std::move(parts.second), depth + 1, out);
      return;
    }
    typename Policy::Output right_out = policy_.make_output();
    context_.executor.invoke([&] { recurse(std::move(parts.first), depth + 1, out); },
                             [&] { recurse(std::move(parts.second), depth + 1, right_out); });
    policy_.link(out, inner);
    policy_.append(out, std::move(right_out));
  }

  /// Tells the caller about finished primitives, about a hundred times in all.
  void report(std::size_t finished) {
    const std::size_t before = done_.fetch_add(finished, std::memory_order_relaxed);
    const std::size_t step = total_ / 128 + 1;
    if (before / step == (before + finished) / step) return;
    const double fraction = static_cast<double>(before + finished) / static_cast<double>(total_);
    context_.check(fraction < 1.0 ? fraction : 1.0, "building");
  }

  Policy& policy_;
  const BuildContext& context_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
};

}  // namespace strahl
