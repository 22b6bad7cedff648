// structures/two_level/level.h - a structure as one level of a two-level structure: behind virtual
// calls, one per ray and visit of the level, never per node.
//
// A level over primitives (the bottom) is asked with the caller's own query and traces as fast as
// alone. A level over other things (the top) is asked with a ThingQuery: all it has to know is how
// far the ray still matters. That keeps the code small: a structure is compiled for eight pairs of
// query and counters at the bottom and two at the top, and none knows another.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <memory>
#include <string_view>

#include <strahl/base/build_context.h>
#include <strahl/base/hash.h>
#include <strahl/build/build_report.h>
#include <strahl/build/side_tree.h>
#include <strahl/query/counters.h>
#include <strahl/query/instance_visitor.h>
#include <strahl/query/policies.h>

namespace strahl {

class ThingVisitor;

/// What a traversal over things looks for: all of them up to where the query behind it ends.
struct ThingQuery : RayLimits {
  /// Nothing may be left out for the side it turns to the ray.
  static constexpr bool kTestsOrigin = true;
  double nearest;

  explicit ThingQuery(const RayLimits& limits, double t_max) : RayLimits(limits), nearest(t_max) {}
  double t_max() const { return nearest; }
  bool offer(const Hit&) { return false; }  ///< things are no hits; ThingVisitor offers theirs
};

class Level {
 public:
  Level() = default;
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;
  virtual ~Level() = default;

  /// Over primitives, numbered as the source it was built over.
  virtual void trace(ObjectVisitor&, const PreparedRay&, ClosestHit&, NoCounters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, ClosestHit&, Counters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, AnyHit&, NoCounters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, AnyHit&, Counters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, CollectHits&, NoCounters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, CollectHits&, Counters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, InsideTest&, NoCounters&) const = 0;
  virtual void trace(ObjectVisitor&, const PreparedRay&, InsideTest&, Counters&) const = 0;
  /// Over anything else.
  virtual void trace(ThingVisitor&, const PreparedRay&, ThingQuery&, NoCounters&) const = 0;
  virtual void trace(ThingVisitor&, const PreparedRay&, ThingQuery&, Counters&) const = 0;

  virtual BuildReport report() const = 0;
  /// Its volumes, numbered as the source it was built over; null unless it is a tree of volumes.
  virtual std::shared_ptr<const SideTree> side_tree() const = 0;
  /// Throws std::logic_error naming the first broken invariant.
  virtual void validate(const PrimitiveSource& source) const = 0;
  virtual void hash_into(Hash64& hash) const = 0;
};

/// Builds any structure as a level. The source need not outlive the call. Throws Error: usage for a
/// SPEC that names no structure or a bad option; those of the structure's build.
using LevelMaker = std::unique_ptr<Level> (*)(const PrimitiveSource& source, std::string_view spec,
                                              const BuildContext& context);

}  // namespace strahl
