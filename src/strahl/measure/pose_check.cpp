#include <algorithm>
#include <bit>

#include <strahl/catalog/catalog.h>
#include <strahl/measure/pose_check.h>

namespace strahl {
namespace {

bool have_same_bits(const Hit& a, const Hit& b) {
  return std::bit_cast<std::uint64_t>(a.t) == std::bit_cast<std::uint64_t>(b.t) && a.id == b.id &&
         a.is_front == b.is_front && a.reference == b.reference;
}

/// The first place where the lists differ; their length where they do not.
std::size_t first_difference(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return static_cast<std::size_t>(
      std::mismatch(a.begin(), a.end(), b.begin(), b.end(), have_same_bits).first - a.begin());
}

std::vector<Ray> make_rays(const Accelerator& accelerator, WorkloadOptions options,
                           const BuildContext& context) {
  const std::size_t wanted = options.rays;
  options.rays = wanted / 2;
  std::vector<Ray> rays =
      make_workload(WorkloadKind::primary, accelerator, options, context).closest;
  rays.resize(std::min(rays.size(), options.rays));
  options.rays = wanted - rays.size();
  const std::vector<Ray> random =
      make_workload(WorkloadKind::random, accelerator, options, context).closest;
  rays.insert(rays.end(), random.begin(), random.end());
  return rays;
}

}  // namespace

PoseCheck check_pose(const Accelerator& moved, const std::shared_ptr<const Scene>& loaded,
                     const std::string& spec, const WorkloadOptions& options,
                     const BuildContext& context) {
  PoseCheck check;
  const auto anew = build(loaded, spec, context);
  check.rebuild_seconds = anew->report().seconds;
  const std::vector<Ray> rays = make_rays(*anew, options, context);
  const RayBatch batch = make_batch(rays);
  const BatchContext tracing{context};
  std::vector<Hit> first(rays.size()), expected_first(rays.size());
  moved.closest_hit(batch, first, tracing);
  anew->closest_hit(batch, expected_first, tracing);
  AllHits all, expected;
  moved.all_hits(batch, all, tracing);
  anew->all_hits(batch, expected, tracing);
  check.rays = rays.size();
  check.hits = expected.hits.size();
  if (const std::size_t i = first_difference(first, expected_first); i < first.size())
    check.difference = "the first hit of ray " + std::to_string(i);
  else if (all.splits != expected.splits)
    check.difference = "the number of hits of a ray";
  else if (const std::size_t h = first_difference(all.hits, expected.hits); h < all.hits.size())
    check.difference = "hit " + std::to_string(h);
  return check;
}

}  // namespace strahl
