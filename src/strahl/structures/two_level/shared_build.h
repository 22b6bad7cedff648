// structures/two_level/shared_build.h - builds several levels under one grant of memory and
// progress.
//
// Thread safety: pure functions besides what they are given.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <strahl/structures/two_level/level.h>

namespace strahl {

/// One of the levels: how much of the work it is, and how to build it.
struct LevelTask {
  std::uint64_t weight;
  std::function<std::unique_ptr<Level>(const BuildContext&)> build;
};

/// Builds all, side by side. With a memory limit one after the other, each granted what the others
/// leave, as peaks would add up. The result does not depend on threads or limit.
std::vector<std::unique_ptr<Level>> build_levels(std::span<const LevelTask> tasks,
                                                 const BuildContext& context);

/// What a build may still own once `bytes` are.
BuildContext after_owning(const BuildContext& context, std::uint64_t bytes);

/// The report of several levels side by side; depth is that of the deepest.
BuildReport sum_of(std::span<const std::unique_ptr<Level>> levels);
/// A level above others: the report of both.
BuildReport stacked(const BuildReport& top, const BuildReport& bottoms);
/// Their trees; null unless all are trees of volumes.
std::shared_ptr<const SideTree> stacked(const std::shared_ptr<const SideTree>& top,
                                        std::span<const SideTree::Thing> things);

}  // namespace strahl
