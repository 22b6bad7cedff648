#include <algorithm>
#include <atomic>
#include <cmath>

#include <strahl/structures/two_level/shared_build.h>

namespace strahl {
namespace {

/// Turns the progress of single levels into that of all. Runs under the lock of the callback.
class JointProgress {
 public:
  JointProgress(std::span<const LevelTask> tasks, const BuildContext& context) : context_(context) {
    for (const LevelTask& task : tasks) total_ += static_cast<double>(task.weight);
  }
  BuildContext context_for(const LevelTask& task) {
    BuildContext own = context_;
    if (!context_.progress) return own;
    own.progress = [this, weight = static_cast<double>(task.weight), last = 0.0](
                       double fraction, std::string_view stage) mutable {
      // Some builders begin anew per stage; what counts is how far they ever came.
      const double gain = std::max(0.0, std::min(fraction, 1.0) - last);
      last += gain, done_ += gain * weight;
      return context_.progress(total_ > 0.0 ? std::min(1.0, done_ / total_) : 1.0, stage);
    };
    return own;
  }

 private:
  const BuildContext& context_;
  double total_ = 0.0, done_ = 0.0;
};

/// Adds up what both kinds of sums need; binning_loss is a mean over planes.
void add(BuildReport& sum, const BuildReport& part) {
  const auto planes = static_cast<double>(sum.binned_planes + part.binned_planes);
  if (planes > 0.0)
    sum.binning_loss = (sum.binning_loss * static_cast<double>(sum.binned_planes) +
                        part.binning_loss * static_cast<double>(part.binned_planes)) /
                       planes;
  sum.largest_binning_loss = std::max(sum.largest_binning_loss, part.largest_binning_loss);
  sum.binned_planes += part.binned_planes;
  sum.nodes += part.nodes, sum.leaves += part.leaves, sum.empty_leaves += part.empty_leaves;
  sum.references += part.references, sum.bytes += part.bytes;
}

}  // namespace

std::vector<std::unique_ptr<Level>> build_levels(std::span<const LevelTask> tasks,
                                                 const BuildContext& context) {
  std::vector<std::unique_ptr<Level>> levels(tasks.size());
  JointProgress progress(tasks, context);
  if (context.memory_limit != UINT64_MAX) {
    std::uint64_t owned = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      levels[i] = tasks[i].build(after_owning(progress.context_for(tasks[i]), owned));
      owned += levels[i]->report().bytes;
    }
    return levels;
  }
  context.executor.parallel_for(0, tasks.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      levels[i] = tasks[i].build(progress.context_for(tasks[i]));
  });
  return levels;
}

BuildContext after_owning(const BuildContext& context, std::uint64_t bytes) {
  BuildContext rest = context;
  if (rest.memory_limit != UINT64_MAX) rest.memory_limit -= std::min(bytes, rest.memory_limit);
  return rest;
}

BuildReport sum_of(std::span<const std::unique_ptr<Level>> levels) {
  BuildReport sum;
  for (const std::unique_ptr<Level>& level : levels) {
    const BuildReport part = level->report();
    add(sum, part);
    sum.depth = std::max(sum.depth, part.depth);
  }
  return sum;
}

BuildReport stacked(const BuildReport& top, const BuildReport& bottoms) {
  BuildReport sum = top;
  add(sum, bottoms);
  sum.depth = top.depth + 1 + bottoms.depth;
  return sum;
}

std::shared_ptr<const SideTree> stacked(const std::shared_ptr<const SideTree>& top,
                                        std::span<const SideTree::Thing> things) {
  const auto is_known = [](const SideTree::Thing& thing) { return thing.tree != nullptr; };
  if (top == nullptr || !std::all_of(things.begin(), things.end(), is_known)) return nullptr;
  return std::make_shared<const SideTree>(with_things(*top, things));
}

}  // namespace strahl
