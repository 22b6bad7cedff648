// catalog/level_of.h - turns a structure into a level of a two-level structure. Only the generated
// file of each structure includes it, so no translation unit sees two structures.
#pragma once

#include <strahl/catalog/catalog.h>
#include <strahl/catalog/measured_tree.h>
#include <strahl/structures/two_level/thing_visitor.h>

namespace strahl {

template <class S>
class LevelOf final : public Level {
 public:
  LevelOf(const PrimitiveSource& source, const typename S::Options& options,
          const BuildContext& context)
      : structure_(source, options, context) {}

  void trace(ObjectVisitor& p, const PreparedRay& r, ClosestHit& q, NoCounters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, ClosestHit& q, Counters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, AnyHit& q, NoCounters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, AnyHit& q, Counters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, CollectHits& q, NoCounters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, CollectHits& q, Counters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, InsideTest& q, NoCounters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ObjectVisitor& p, const PreparedRay& r, InsideTest& q, Counters& c) const override {
    structure_.trace(p, r, q, c);
  }
  void trace(ThingVisitor& t, const PreparedRay& r, ThingQuery& q, NoCounters& c) const override {
    structure_.trace(t, r, q, c);
  }
  void trace(ThingVisitor& t, const PreparedRay& r, ThingQuery& q, Counters& c) const override {
    structure_.trace(t, r, q, c);
  }

  BuildReport report() const override { return structure_.report(); }
  std::shared_ptr<const SideTree> side_tree() const override { return side_tree_of(structure_); }
  void validate(const PrimitiveSource& source) const override { structure_.validate(source); }
  void hash_into(Hash64& hash) const override { structure_.hash_into(hash); }

 private:
  S structure_;
};

/// A structure made of levels, which knows how to be one itself.
template <class S>
concept MadeOfLevels = requires(const PrimitiveSource& source, const typename S::Options& options,
                                const BuildContext& context) {
  { S::as_level(source, options, context, &build_level) } -> std::same_as<std::unique_ptr<Level>>;
};

template <class S>
std::unique_ptr<Level> make_level(const PrimitiveSource& source, std::span<const OptionValue> given,
                                  const BuildContext& context) {
  const auto options = parse_options<typename S::Options>(given, S::kName);
  if constexpr (MadeOfLevels<S>)
    return S::as_level(source, options, context, &build_level);
  else
    return std::make_unique<LevelOf<S>>(source, options, context);
}

}  // namespace strahl
