#include <strahl/structures/quadtree/quadtree.h>

namespace strahl {
namespace {

int shortest_axis(const PrimitiveSource& source) {
  Aabb box;
  for (std::uint32_t i = 0; i < source.size(); ++i) box.extend(source.bounds(i));
  if (box.is_empty()) return 2;
  const Vec3d size = box.extent();
  return size.z <= size.x && size.z <= size.y ? 2 : size.y <= size.x ? 1 : 0;
}

OctantAxes axes_of(const QuadtreeOptions& options, const PrimitiveSource& source) {
  switch (options.undivided) {
    case QuadtreeAxis::x:
      return OctantAxes::all_but(0);
    case QuadtreeAxis::y:
      return OctantAxes::all_but(1);
    case QuadtreeAxis::z:
      return OctantAxes::all_but(2);
    default:
      return OctantAxes::all_but(shortest_axis(source));
  }
}

}  // namespace

OptionTable<QuadtreeOptions> option_fields(const QuadtreeOptions*) {
  OptionTable<QuadtreeOptions> table = octant_fields<QuadtreeOptions>();
  table.push_back(option("undivided", &QuadtreeOptions::undivided,
                         {{"shortest", QuadtreeAxis::shortest},
                          {"x", QuadtreeAxis::x},
                          {"y", QuadtreeAxis::y},
                          {"z", QuadtreeAxis::z}},
                         "axis that is not divided: that of the scene's shortest side, or a given "
                         "one"));
  return table;
}

Quadtree::Quadtree(const PrimitiveSource& source, const Options& options,
                   const BuildContext& context)
    : tree_(source, options, axes_of(options, source), context, kName),
      traversal_(options.traversal) {}

}  // namespace strahl
