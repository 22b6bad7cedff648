// structures/bvh/volume_tree.h - what a bvh holds: nodes over some kind of bounding volume.
#pragma once

#include <optional>

#include <strahl/base/hash.h>
#include <strahl/build/build_report.h>
#include <strahl/build/hierarchy.h>
#include <strahl/build/side_tree.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/query/counters.h>
#include <strahl/query/volume_entry.h>
#include <strahl/structures/bvh/bvh_options.h>
#include <strahl/traverse/leaf_query.h>

namespace strahl {

/// The kind is known once per ray, behind one virtual call. Thread safety: const methods are safe
/// from any number of threads.
class VolumeTree {
 public:
  VolumeTree() = default;
  VolumeTree(const VolumeTree&) = delete;
  VolumeTree& operator=(const VolumeTree&) = delete;
  virtual ~VolumeTree() = default;

  virtual void trace(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
                     NoCounters& counters) const = 0;
  virtual void trace(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
                     Counters& counters) const = 0;
  /// See Accelerator::first_volume().
  virtual VolumeEntry first_volume(const PreparedRay& ray, int depth) const = 0;
  virtual const BuildReport& report() const = 0;
  /// Its nodes and references without boxes.
  virtual Hierarchy hierarchy() const = 0;
  /// With boxes, where its volumes are boxes along the axes.
  virtual std::optional<Hierarchy> box_hierarchy() const = 0;
  /// With the sides of its volumes; the cost is left as it is by default.
  virtual SideTree side_tree() const = 0;
  /// @param refers_once whether no primitive may be in two leaves
  virtual void validate(const PrimitiveSource& source, bool refers_once) const = 0;
  virtual void hash_into(Hash64& hash) const = 0;
};

}  // namespace strahl
