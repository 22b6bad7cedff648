// build/object_split.h - how a set of primitives is divided in two: two SAH splitters, median cut,
// one that divides space and one along a curve.
//
// A splitter orders or sorts its primitives in place: left part first. The SAH splitters choose
// among all three axes by the surface area heuristic; ties go to the lower cost, then the lower
// axis, then the lower position, so results depend on the input only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>
#include <strahl/build/sah.h>

namespace strahl {

/// Primitives [begin, begin + size()) of the builder's array and their box.
struct ObjectSet {
  std::size_t begin = 0, end = 0;
  Aabb box;
  Aabb cell{};     ///< holds all centres; kept by splitters that divide space, else empty
  int turn = 0;    ///< the axis whose turn it is; kept by splitters that take them in turn
  Aabb centers{};  ///< box of the doubled centres, where the splitter has found it already
  std::size_t size() const { return end - begin; }
};

/// A division found: cost of node and two leaves, infinite when there is none.
struct ObjectSplit {
  double cost = Aabb::kInf;
  int axis = 0;
  std::size_t position = 0;  ///< meaning is the splitter's: bin or rank
  Aabb centers;              ///< of the doubled centres, if the splitter's positions depend on it
  bool is_found() const { return cost < Aabb::kInf; }
};

/// Finds and carries out divisions. Disjoint sets may be worked on from several threads at once.
class ObjectSplitter {
 public:
  virtual ~ObjectSplitter() = default;
  /// The cheapest division of a set of at least two.
  virtual ObjectSplit find(const ObjectSet& set) const = 0;
  /// Halves by rank of the centres on the longest axis of their box; always found.
  virtual ObjectSplit find_median(const ObjectSet& set) const = 0;
  /// Carries a division out and returns both parts with their boxes.
  virtual std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set,
                                                 const ObjectSplit& split) = 0;
  /// References of a set, in no particular order, appended.
  virtual void list(const ObjectSet& set, std::vector<std::uint32_t>& references) const = 0;
};

/// Binned SAH [Wald2007]: `bins` equal bins over the centres per axis. O(n) per division, sorts the
/// references in place. `refs` must outlive it.
std::unique_ptr<ObjectSplitter> make_binned_splitter(std::span<PrimRef> refs, int bins,
                                                     const SahCost& cost);

/// Exact SAH sweep over the sorted centres of all axes [GoldsmithSalmon1987, MuellerFellner1999]:
/// sorted once, kept sorted by stable partition, O(n log n) in all. `refs` must outlive it.
std::unique_ptr<ObjectSplitter> make_sweep_splitter(std::span<const PrimRef> refs,
                                                    const SahCost& cost);

/// The middle of the set's cell on its longest axis, the cell of the root being its box; a cell is
/// halved without dividing the set as long as all centres lie on one side [Waechter2006]. Costs as
/// much as a leaf, so only sets too large for a leaf are divided. O(n) per division, sorts the
/// references in place. `refs` must outlive it.
std::unique_ptr<ObjectSplitter> make_middle_splitter(std::span<PrimRef> refs, const SahCost& cost);

/// How median cut chooses the axis: x, y and z by depth, or the longest of the box of the centres.
enum class MedianAxis { cyclic, longest };

/// Median cut [KayKajiya1986]: the lower half of the centres to the left. Costs as much as a leaf,
/// so only sets too large for a leaf are divided, into ceil(log2(n / leaf)) levels. O(n) expected
/// per division, sorts the references in place. `refs` must outlive it.
std::unique_ptr<ObjectSplitter> make_median_splitter(std::span<PrimRef> refs, MedianAxis rule,
                                                     const SahCost& cost);

/// LBVH [Lauterbach2009]: at the highest bit in which the Morton codes of the centres differ
/// (build/morton_order.h), between equal codes at the median. Costs as much as a leaf. O(log n) to
/// find and O(n) to bound the halves per division. `refs` must outlive it; n > 0.
std::unique_ptr<ObjectSplitter> make_morton_splitter(std::span<const PrimRef> refs,
                                                     const SahCost& cost,
                                                     const BuildContext& context);

/// Where the modeller put a reference.
struct ScenePart {
  std::uint32_t instance = 0, geometry = 0;
};

/// The groups of the model [RubinWhitted1980]: between instances, then between geometries, at the
/// border nearest to the middle; inside a geometry, file order is halved. Primitives of different
/// groups are never in one leaf. `parts` are those of the references, ascending by instance, then
/// geometry. O(log n) to find and O(n) to bound the halves per division. Both must outlive it.
std::unique_ptr<ObjectSplitter> make_scene_graph_splitter(std::span<const PrimRef> refs,
                                                          std::span<const ScenePart> parts,
                                                          const SahCost& cost);

/// Twice the centre of a box: what all splitters sort by, without a rounding.
inline Vec3d doubled_center(const Aabb& box) { return box.lo + box.hi; }

}  // namespace strahl
