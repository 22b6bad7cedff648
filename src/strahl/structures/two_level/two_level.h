// structures/two_level/two_level.h - any structure over the instances of a scene, any structure
// over the primitives of each object they place. Moving instances renews only the top.
//
// Source: rigid parts with structures of their own under one over the parts, of which only that one
//   is renewed when parts move [LextAkenineMoller2001, WaldBenthinSlusallek2003].
// Layout: one level over the world boxes of all instances; one per distinct object in its object
//   space, shared by the instances that place it; a table from instance to level.
// Invariants: the top holds the world boxes of the instances as they are now; the box of an
//   instance holds all its primitives; instances of one object share one level.
// Differs from the sources: any structure on either level; directions are not renormalised and
//   world boxes are met with a margin, so the hits have the bits of a flat structure.
// Thread safety: const methods are safe from any number of threads; move() excludes them.
#pragma once

#include <string>
#include <vector>

#include <strahl/base/options.h>
#include <strahl/geometry/instance_source.h>
#include <strahl/query/scene_visitor.h>
#include <strahl/structures/two_level/thing_visitor.h>

namespace strahl {

struct TwoLevelOptions {
  std::string top = "bvh", bottom = "bvh";
};

OptionTable<TwoLevelOptions> option_fields(const TwoLevelOptions*);

/// A ray costs the top's traversal, and a transformation and the bottom's for each instance met.
class TwoLevel {
 public:
  using Options = TwoLevelOptions;
  static constexpr const char* kName = "two_level";
  static constexpr const char* kTitle = "any structure over instances of any structure";
  static constexpr bool kRefersOnce = false;

  TwoLevel(const Scene& scene, const Options& options, const BuildContext& context,
           LevelMaker make_level);
  /// Inside another two-level structure there are no instances below: runs of the source's things
  /// take their place, see run_level.h.
  static std::unique_ptr<Level> as_level(const PrimitiveSource& source, const Options& options,
                                         const BuildContext& context, LevelMaker make_level);

  template <class Q, class C>
  void trace(SceneVisitor& prims, const PreparedRay& ray, Q& query, C& counters) const {
    ThingVisitor instances(prims.scene(), level_of_, &query);
    ThingQuery things(query, query.t_max());
    top_->trace(instances, ray, things, counters);
  }

  /// Takes the places of a pose of the scene built over, which must outlive the structure: a new
  /// top, the same bottoms; the result is that of a build. Succeeds or changes nothing.
  /// O(build of the top).
  void move(const Scene& pose, const BuildContext& context);

  /// Sums of both levels; depth counts the step from top to bottom; sah_cost weights each bottom by
  /// the chance that a line through the scene meets its instance's box.
  BuildReport report() const;
  /// Both levels, each bottom below all instances that share it; null unless both are trees of
  /// volumes.
  std::shared_ptr<const SideTree> side_tree() const;
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const Scene& scene) const;
  void hash_into(Hash64& hash) const;

 private:
  friend class TwoLevelBreaker;  ///< plants faults for the tests
  std::unique_ptr<Level> make_top(const InstanceSource& instances,
                                  const BuildContext& context) const;
  void make_bottoms(const Scene& scene, const BuildContext& context);
  std::uint64_t table_bytes() const;

  Options options_;
  LevelMaker make_level_;
  InstanceSource instances_;  ///< of the scene as it is now
  std::unique_ptr<Level> top_;
  std::vector<std::unique_ptr<Level>> bottoms_;  ///< per object
  std::vector<const Level*> level_of_;           ///< per instance
};

}  // namespace strahl
