// structures/two_level/thing_visitor.h - leads from the things of an upper level to their own
// levels: from an instance to its object, from a run of primitives or things to the run.
//
// Things are instances, runs of primitives or runs of things; which, is a branch that goes the same
// way for all visits of a level. The query behind the traversal is one of four, and likewise.
// Thread safety: one visitor per thread.
#pragma once

#include <span>
#include <variant>

#include <strahl/structures/two_level/level.h>

namespace strahl {

/// The query behind a traversal over things.
using QueryBehind = std::variant<ClosestHit*, AnyHit*, CollectHits*, InsideTest*>;

/// Consecutive things of one source as things themselves: run i begins at starts[i].
struct Runs {
  std::span<const std::uint32_t> starts;
  std::span<const Level* const> level_of;
};

/// Remembers a stop. All it is made of must outlive it.
class ThingVisitor {
 public:
  /// Things are the instances of the scene. @param level_of of each instance's object
  ThingVisitor(const Scene& scene, std::span<const Level* const> level_of, QueryBehind query)
      : scene_(&scene), runs_{{}, level_of}, query_(query) {}
  /// Things are runs of primitives.
  ThingVisitor(ObjectVisitor& prims, const Runs& runs, QueryBehind query)
      : prims_(&prims), runs_(runs), query_(query) {}
  /// Things are runs of things.
  ThingVisitor(ThingVisitor& things, const Runs& runs)
      : things_(&things), runs_(runs), query_(things.query_) {}

  /// True stops the traversal.
  template <class C>
  bool visit(std::uint32_t thing, const PreparedRay& ray, ThingQuery& query, C& counters) {
    if (things_ != nullptr) return has_stopped_ = visit_run_of_things(thing, ray, query, counters);
    std::visit(
        [&](auto* behind) {
          has_stopped_ = prims_ != nullptr ? visit_run_of_prims(thing, ray, *behind, counters)
                                           : visit_instance(thing, ray, *behind, counters);
          query.nearest = behind->t_max();
        },
        query_);
    return has_stopped_;
  }
  bool has_stopped() const { return has_stopped_; }

 private:
  /// The things of another from number `first` on.
  ThingVisitor(const ThingVisitor& whole, std::uint32_t first) : ThingVisitor(whole) {
    first_ += first;
  }

  template <class Q, class C>
  bool visit_instance(std::uint32_t thing, const PreparedRay& ray, Q& query, C& counters) {
    InstanceVisitor<Level> instances(*scene_, runs_.level_of);
    return instances.visit(first_ + thing, ray, query, counters);
  }

  template <class Q, class C>
  bool visit_run_of_prims(std::uint32_t thing, const PreparedRay& ray, Q& query, C& counters) {
    const std::uint32_t run = first_ + thing;
    ObjectVisitor members(*prims_, runs_.starts[run]);
    runs_.level_of[run]->trace(members, ray, query, counters);
    return prims_->end_run(members);
  }

  template <class C>
  bool visit_run_of_things(std::uint32_t thing, const PreparedRay& ray, ThingQuery& query,
                           C& counters) {
    const std::uint32_t run = first_ + thing;
    ThingVisitor members(*things_, runs_.starts[run]);
    runs_.level_of[run]->trace(members, ray, query, counters);
    return things_->has_stopped_ = members.has_stopped_;
  }

  const Scene* scene_ = nullptr;
  ObjectVisitor* prims_ = nullptr;
  ThingVisitor* things_ = nullptr;
  Runs runs_;
  std::uint32_t first_ = 0;
  QueryBehind query_;
  bool has_stopped_ = false;
};

}  // namespace strahl
