#include <strahl/structures/proximity_cloud/proximity_cloud.h>

#include <span>
#include <stdexcept>

namespace strahl {

OptionTable<ProximityCloudOptions> option_fields(const ProximityCloudOptions*) {
  return {option("box_first", &ProximityCloudOptions::box_first, "test the box around all first")};
}

ProximityCloud::ProximityCloud(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : box_first_(options.box_first) {
  for (const PrimRef& ref : make_prim_refs(source, context)) {
    box_.extend(ref.box);
    references_.push_back(ref.reference);
  }
}

BuildReport ProximityCloud::report() const {
  BuildReport report;
  report.nodes = report.leaves = 1;
  report.empty_leaves = references_.empty();
  report.references = references_.size();
  report.bytes = references_.capacity() * sizeof(std::uint32_t);
  report.sah_cost = static_cast<double>(references_.size());
  return report;
}

void ProximityCloud::validate(const PrimitiveSource& source) const {
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    const Aabb box = source.bounds(i);
    if (box.is_empty()) continue;
    if (next == references_.size() || references_[next++] != i || !box_.contains(box))
      throw std::logic_error("proximity_cloud: a primitive that can be hit is not listed once in the box");
  }
}

void ProximityCloud::hash_into(Hash64& hash) const {
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl
