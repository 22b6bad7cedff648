#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <strahl/geometry/outline.h>
#include <strahl/structures/two_level/run_level.h>
#include <strahl/structures/two_level/shared_build.h>

namespace strahl {
namespace {

/// Things [first, last) of a source, numbered from 0.
class RunSource final : public PrimitiveSource {
 public:
  RunSource(const PrimitiveSource& all, std::uint32_t first, std::uint32_t last)
      : all_(all), first_(first), size_(last - first) {}

  std::uint32_t size() const override { return size_; }
  Aabb bounds(std::uint32_t i) const override { return all_.bounds(first_ + i); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override { return all_.clip(first_ + i, box); }
  Outline outline(std::uint32_t i) const override { return all_.outline(first_ + i); }
  bool triangle(std::uint32_t i, TriangleVertices& vertices) const override {
    return all_.triangle(first_ + i, vertices);
  }

 private:
  const PrimitiveSource& all_;
  std::uint32_t first_, size_;
};

/// The runs themselves.
class RunBoxes final : public PrimitiveSource {
 public:
  RunBoxes(const PrimitiveSource& all, std::span<const std::uint32_t> starts) {
    for (std::size_t run = 0; run < starts.size(); ++run) {
      const std::uint32_t end = run + 1 < starts.size() ? starts[run + 1] : all.size();
      Aabb box;
      for (std::uint32_t i = starts[run]; i < end; ++i) box.extend(all.bounds(i));
      boxes_.push_back(box);
    }
  }
  std::uint32_t size() const override { return static_cast<std::uint32_t>(boxes_.size()); }
  Aabb bounds(std::uint32_t i) const override { return boxes_[i]; }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(boxes_[i], box);
  }

 private:
  std::vector<Aabb> boxes_;
};

std::vector<std::uint32_t> divide(std::uint32_t size) {
  const auto length = static_cast<std::uint32_t>(std::ceil(std::sqrt(double{1} * size)));
  std::vector<std::uint32_t> starts;
  for (std::uint64_t first = 0; first < size; first += length)
    starts.push_back(static_cast<std::uint32_t>(first));
  return starts;
}

RunSource run_of(const PrimitiveSource& source, std::span<const std::uint32_t> starts,
                 std::size_t run) {
  return {source, starts[run], run + 1 < starts.size() ? starts[run + 1] : source.size()};
}

}  // namespace

RunLevel::RunLevel(const PrimitiveSource& source, const TwoLevelOptions& options,
                   const BuildContext& context, LevelMaker make_level)
    : size_(source.size()), starts_(divide(size_)) {
  std::vector<LevelTask> tasks;
  for (std::size_t run = 0; run < starts_.size(); ++run)
    tasks.push_back({run_of(source, starts_, run).size(), [&, run](const BuildContext& own) {
                       return make_level(run_of(source, starts_, run), options.bottom, own);
                     }});
  // Over nothing, to find mistakes in the SPEC.
  if (tasks.empty()) make_level(source, options.bottom, {});
  bottoms_ = build_levels(tasks, context);
  for (const std::unique_ptr<Level>& bottom : bottoms_) level_of_.push_back(bottom.get());
  top_ = make_level(RunBoxes(source, starts_), options.top,
                    after_owning(context, sum_of(bottoms_).bytes));
}

BuildReport RunLevel::report() const {
  const BuildReport top = top_->report(), below = sum_of(bottoms_);
  BuildReport report = stacked(top, below);
  report.bytes += starts_.capacity() * sizeof(std::uint32_t) +
                  bottoms_.capacity() * sizeof(bottoms_[0]) +
                  level_of_.capacity() * sizeof(level_of_[0]);
  // A run met by the top costs its bottom; on average, as boxes of runs are not kept.
  double cost = 0.0;
  for (const std::unique_ptr<Level>& bottom : bottoms_) cost += bottom->report().sah_cost;
  if (!bottoms_.empty()) report.sah_cost *= 1.0 + cost / static_cast<double>(bottoms_.size());
  return report;
}

std::shared_ptr<const SideTree> RunLevel::side_tree() const {
  std::vector<SideTree::Thing> runs;
  for (std::size_t run = 0; run < bottoms_.size(); ++run) {
    const std::uint32_t end = run + 1 < starts_.size() ? starts_[run + 1] : size_;
    runs.push_back({bottoms_[run]->side_tree(), starts_[run], end - starts_[run], {}});
  }
  return stacked(top_->side_tree(), runs);
}

void RunLevel::validate(const PrimitiveSource& source) const {
  if (starts_ != divide(source.size())) throw std::logic_error("two_level: runs are cut wrongly");
  top_->validate(RunBoxes(source, starts_));
  for (std::size_t run = 0; run < bottoms_.size(); ++run) {
    bottoms_[run]->validate(run_of(source, starts_, run));
    if (level_of_[run] != bottoms_[run].get())
      throw std::logic_error("two_level: a run has the level of another");
  }
}

void RunLevel::hash_into(Hash64& hash) const {
  top_->hash_into(hash);
  for (const std::unique_ptr<Level>& bottom : bottoms_) bottom->hash_into(hash);
}

}  // namespace strahl
