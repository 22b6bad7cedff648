// structures/ray_classification/ray_classification.h - rays sorted into five-dimensional cells,
// each with a list of what its rays can hit.
//
// Source: [ArvoKirk1987].
// Layout: groups of primitives, fixed at build (candidates.h); six roots, one per face of the
//   direction cube, and six for queries that cull back faces; below them cells that rays make when
//   they need them (cell_cache.h).
// Invariants: the list of a cell holds every group that a ray of the cell can hit, in the order in
//   which rays of the face can enter the groups; it is the list of the parent, filtered, so it
//   depends on the path alone. A cell has children only if its list is longer than max_candidates
//   and its depth below that of min_cell.
// Why answers do not depend on what is divided so far: each list on the path of a ray serves it,
//   and every group is tested with the ray as given. Only the counters depend on it.
// Differs from the paper: candidates are groups; a cell is divided after a few rays, not the first;
//   least recently used lists are evicted while others read; triangles are sorted out by the sides
//   on which rays pass their edges.
// Thread safety: const methods are safe from any number of threads; trace() divides cells.
#pragma once

#include <memory>

#include <strahl/base/options.h>
#include <strahl/build/build_report.h>
#include <strahl/query/counters.h>
#include <strahl/structures/ray_classification/candidates.h>
#include <strahl/structures/ray_classification/cell_cache.h>
#include <strahl/traverse/leaf.h>

namespace strahl {

/// README.md says how the defaults were measured.
struct RayClassificationOptions {
  int max_candidates = 256;
  double min_cell = 0.02;
  int group_size = 8;
  int patience = 8;
  int bytes_per_primitive = 1024;
};

OptionTable<RayClassificationOptions> option_fields(const RayClassificationOptions*);

/// O(list) per ray, and O(list of the parent) for each cell it adds. Never owns more than
/// bytes_per_primitive or the memory limit of the build, whichever is less, allow.
class RayClassification {
 public:
  using Options = RayClassificationOptions;
  static constexpr const char* kName = "ray_classification";
  static constexpr const char* kTitle = "5-D octree over rays with lists of candidates";
  static constexpr bool kRefersOnce = true;

  RayClassification(const PrimitiveSource& source, const Options& options,
                    const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (candidates_.empty()) return;
    const std::optional<RayPoint> point = candidates_.space().classify(ray);
    if (!point) return;
    const Epochs::Reader reading = cells_->reader();
    test_list(find_list(*point, culls(query), counters), point->face, prims, ray, query, counters);
  }

  /// The primitives in the list that serves the ray, ascending. Makes cells as trace() does.
  std::vector<std::uint32_t> candidates_of(const PreparedRay& ray, bool culls) const;

  /// Of the cells at this moment: changes while rays are traced.
  BuildReport report() const;
  CellCache::Figures figures() const { return cells_ ? cells_->figures() : CellCache::Figures{}; }
  /// Throws std::logic_error naming the first broken invariant; checks the cells there are, too.
  void validate(const PrimitiveSource& source) const;
  /// What is fixed at build. Cells follow from it and the rays traced, so they are not part of it.
  void hash_into(Hash64& hash) const;

 private:
  friend class RayClassificationChecker;
  friend class RayClassificationBreaker;  ///< plants faults for the tests
  using Cell = CellCache::Cell;

  /// A point on a surface must be found from behind, too.
  template <class Q>
  static bool culls(const Q& query) {
    if constexpr (Q::kTestsOrigin) return false;
    return query.filter.cull_back;
  }
  static std::size_t root_of(int face, bool culls) {
    return static_cast<std::size_t>(face) + (culls ? std::size_t{kFaces} : 0);
  }
  bool is_divided(const Cell& cell, int depth) const {
    return depth < max_depth_ && cell.list().size() > max_candidates_;
  }

  /// The list of the smallest cell there is for the point. Valid while the caller is a reader.
  template <class C>
  std::span<const std::uint32_t> find_list(const RayPoint& point, bool culls, C& counters) const {
    Cell* cell = &cells_->root(root_of(point.face, culls));
    RayCell space = candidates_.space().root();
    for (int depth = 0; point.is_certain && is_divided(*cell, depth); ++depth) {
      counters.traversal_step();
      const unsigned number = space.descend(point);
      Cell* child = cell->child(number);
      if (child == nullptr && cells_->wants(*cell, number))
        child = add_child(*cell, number, space, point.face, culls);
      if (child == nullptr) break;
      cell = child;
    }
    cells_->touch(*cell);
    return cell->list();
  }
  Cell* add_child(Cell& parent, unsigned number, const RayCell& space, int face, bool culls) const;

  /// The list is in the order in which rays of the face enter the groups, which ends it early.
  template <class Prims, class Q, class C>
  void test_list(std::span<const std::uint32_t> list, int face, Prims& prims,
                 const PreparedRay& ray, Q& query, C& counters) const {
    counters.leaf_entered(list.empty());
    const int axis = face / 2;
    for (const std::uint32_t i : list) {
      const CandidateGroup& group = candidates_.group(i);
      const double first =
          ray.plane_first(axis, (ray.negative[axis] ? group.box.hi : group.box.lo)[axis]);
      if (first > ray.t_exit) return;
      if (first > 0.0 && !may_hit_before(first, query.t_max())) return;
      counters.volume_tests(1);
      const Interval span = clip_to_box(ray, group.box.lo, group.box.hi, {ray.t_enter, ray.t_exit});
      if (span.t_enter > span.t_exit || !may_hit_before(span.t_enter, query.t_max())) continue;
      if (test_references(candidates_.references(group), prims, ray, query, counters)) return;
    }
  }

  Candidates candidates_;
  std::size_t max_candidates_;
  int max_depth_;
  std::unique_ptr<CellCache> cells_;  ///< what rays change; null when there is nothing to hit
};

}  // namespace strahl
