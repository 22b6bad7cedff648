// structures/two_level/run_level.h - two levels inside a level: a structure over runs of
// consecutive things, and one over the things of each run.
//
// Inside a two-level structure nothing is instanced any more: a ray is transformed once, world to
// leaf, so further levels only filter. They divide what they are given (primitives of an object, or
// instances) into runs of about the square root of its number. Readers number nodes depth-first and
// modelling programs write neighbours together, so runs are mostly compact.
// Layout: the top over the boxes of all runs, one bottom per run.
// Invariants: runs follow each other without gaps; all but the last have the same length.
// Thread safety: as Level.
#pragma once

#include <vector>

#include <strahl/structures/two_level/two_level.h>

namespace strahl {

class RunLevel final : public Level {
 public:
  RunLevel(const PrimitiveSource& source, const TwoLevelOptions& options,
           const BuildContext& context, LevelMaker make_level);

  void trace(ObjectVisitor& p, const PreparedRay& r, ClosestHit& q, NoCounters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, ClosestHit& q, Counters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, AnyHit& q, NoCounters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, AnyHit& q, Counters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, CollectHits& q, NoCounters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, CollectHits& q, Counters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, InsideTest& q, NoCounters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, InsideTest& q, Counters& c) const override {
    trace_prims(p, r, q, c);
  }
  void trace(ThingVisitor& t, const PreparedRay& r, ThingQuery& q, NoCounters& c) const override {
    trace_things(t, r, q, c);
  }
  void trace(ThingVisitor& t, const PreparedRay& r, ThingQuery& q, Counters& c) const override {
    trace_things(t, r, q, c);
  }

  BuildReport report() const override;
  std::shared_ptr<const SideTree> side_tree() const override;
  void validate(const PrimitiveSource& source) const override;
  void hash_into(Hash64& hash) const override;

 private:
  friend class TwoLevelBreaker;  ///< plants faults for the tests
  template <class Q, class C>
  void trace_prims(ObjectVisitor& prims, const PreparedRay& ray, Q& query, C& counters) const {
    ThingVisitor runs(prims, {starts_, level_of_}, &query);
    ThingQuery things(query, query.t_max());
    top_->trace(runs, ray, things, counters);
  }
  template <class C>
  void trace_things(ThingVisitor& things, const PreparedRay& ray, ThingQuery& query,
                    C& counters) const {
    ThingVisitor runs(things, {starts_, level_of_});
    top_->trace(runs, ray, query, counters);
  }

  std::uint32_t size_;                 ///< of the source
  std::vector<std::uint32_t> starts_;  ///< per run
  std::unique_ptr<Level> top_;
  std::vector<std::unique_ptr<Level>> bottoms_;  ///< per run
  std::vector<const Level*> level_of_;           ///< the same
};

}  // namespace strahl
