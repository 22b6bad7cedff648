#include <algorithm>
#include <stdexcept>
#include <string>

#include <strahl/base/error.h>
#include <strahl/build/sah.h>
#include <strahl/structures/two_level/run_level.h>
#include <strahl/structures/two_level/shared_build.h>
#include <strahl/structures/two_level/two_level.h>

namespace strahl {
namespace {

/// Nothing at all, to try a SPEC on.
class NoThings final : public PrimitiveSource {
 public:
  std::uint32_t size() const override { return 0; }
  Aabb bounds(std::uint32_t) const override { return {}; }
  Aabb clip(std::uint32_t, const Aabb& box) const override { return box; }
};

bool holds_all(const Scene& scene, std::uint32_t instance) {
  const Aabb box = scene.instance_bounds(instance);
  const std::uint32_t first = scene.first_reference(instance);
  for (std::uint32_t r = first; r < first + scene.reference_count(instance); ++r) {
    const Aabb own = scene.bounds(r);
    if (!own.is_empty() && !box.contains(own)) return false;
  }
  return true;
}

[[noreturn]] void broken(const std::string& what) { throw std::logic_error("two_level: " + what); }

}  // namespace

OptionTable<TwoLevelOptions> option_fields(const TwoLevelOptions*) {
  return {
      option_spec("top", &TwoLevelOptions::top, "structure over the instances"),
      option_spec("bottom", &TwoLevelOptions::bottom, "structure over the primitives of an object"),
  };
}

TwoLevel::TwoLevel(const Scene& scene, const Options& options, const BuildContext& context,
                   LevelMaker make_level)
    : options_(options), make_level_(make_level), instances_(scene) {
  make_bottoms(scene, context);
  for (std::uint32_t i = 0; i < instances_.size(); ++i)
    level_of_.push_back(bottoms_[instances_.object_of(i)].get());
  const std::uint64_t bytes = table_bytes() + sum_of(bottoms_).bytes;
  context.require_memory(bytes, kName);
  top_ = make_top(instances_, after_owning(context, bytes));
}

void TwoLevel::make_bottoms(const Scene& scene, const BuildContext& context) {
  // A mistake in the SPEC is one even where there is nothing to build over.
  if (instances_.objects().empty()) make_level_(NoThings(), options_.bottom, {});
  std::vector<LevelTask> tasks;
  for (const std::uint32_t instance : instances_.objects())
    tasks.push_back({scene.reference_count(instance), [&, instance](const BuildContext& own) {
                       return make_level_(ObjectSource(scene, instance), options_.bottom, own);
                     }});
  bottoms_ = build_levels(tasks, context);
}

std::unique_ptr<Level> TwoLevel::make_top(const InstanceSource& instances,
                                          const BuildContext& context) const {
  return make_level_(instances, options_.top, context);
}

std::unique_ptr<Level> TwoLevel::as_level(const PrimitiveSource& source, const Options& options,
                                          const BuildContext& context, LevelMaker make_level) {
  return std::make_unique<RunLevel>(source, options, context, make_level);
}

void TwoLevel::move(const Scene& pose, const BuildContext& context) {
  if (!pose.is_pose_of(instances_.scene()))
    throw Error(ErrorCode::unsupported, "moved vertices cannot be followed; bvh can", kName);
  const InstanceSource moved(pose, instances_);
  const BuildReport bottoms = context.memory_limit == UINT64_MAX ? BuildReport() : sum_of(bottoms_);
  top_ = make_top(moved, after_owning(context, table_bytes() + bottoms.bytes));
  instances_ = moved;
}

std::uint64_t TwoLevel::table_bytes() const {
  return instances_.bytes() + level_of_.capacity() * sizeof(const Level*) +
         bottoms_.capacity() * sizeof(bottoms_[0]);
}

BuildReport TwoLevel::report() const {
  BuildReport report = stacked(top_->report(), sum_of(bottoms_));
  report.bytes += table_bytes();
  Aabb all;
  for (std::uint32_t i = 0; i < instances_.size(); ++i) all.extend(instances_.bounds(i));
  std::vector<double> cost;
  for (const std::unique_ptr<Level>& level : bottoms_) cost.push_back(level->report().sah_cost);
  for (std::uint32_t i = 0; i < instances_.size(); ++i)
    report.sah_cost += sah_share(instances_.bounds(i).half_area(), all.half_area()) *
                       cost[instances_.object_of(i)];
  return report;
}

std::shared_ptr<const SideTree> TwoLevel::side_tree() const {
  const Scene& scene = instances_.scene();
  std::vector<std::shared_ptr<const SideTree>> trees;
  for (const std::unique_ptr<Level>& level : bottoms_) trees.push_back(level->side_tree());
  std::vector<SideTree::Thing> things;
  for (std::uint32_t i = 0; i < instances_.size(); ++i) {
    things.push_back({trees[instances_.object_of(i)], scene.first_reference(i),
                      scene.reference_count(i), std::nullopt});
    if (!scene.is_identity(i)) things.back().placement.emplace(scene.to_object()[i]);
  }
  return stacked(top_->side_tree(), things);
}

void TwoLevel::validate(const Scene& scene) const {
  const InstanceSource instances(scene);
  if (level_of_.size() != instances.size()) broken("instances and levels differ in number");
  top_->validate(instances);
  for (std::size_t object = 0; object < bottoms_.size(); ++object)
    bottoms_[object]->validate(ObjectSource(scene, instances.objects()[object]));
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const std::string name = "instance " + std::to_string(i);
    if (level_of_[i] != bottoms_[instances.object_of(i)].get())
      broken(name + " has the level of another object");
    if (!(instances_.bounds(i) == instances.bounds(i))) broken(name + " is taken for elsewhere");
    if (!holds_all(scene, i)) broken(name + " has primitives outside its box");
  }
}

void TwoLevel::hash_into(Hash64& hash) const {
  top_->hash_into(hash);
  for (const std::unique_ptr<Level>& level : bottoms_) level->hash_into(hash);
}

}  // namespace strahl
