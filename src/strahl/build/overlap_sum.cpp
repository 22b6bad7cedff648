#include <atomic>
#include <vector>

#include <strahl/build/overlap_sum.h>

namespace strahl {

double overlap_share(const Scene& scene, const BuildContext& context,
                     function_ref<OverlapAreas(std::uint32_t, std::uint32_t)> areas) {
  constexpr std::size_t kChunks = 64;
  const std::size_t grain = scene.size() / kChunks + 1;
  std::vector<OverlapAreas> parts(kChunks);
  std::atomic<std::size_t> done{0};
  context.executor.parallel_for(0, scene.size(), grain, [&](std::size_t from, std::size_t to) {
    parts[from / grain] = areas(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to));
    context.check(static_cast<double>(++done) / kChunks, "end-point overlap");
  });
  OverlapAreas all;
  for (const OverlapAreas& part : parts) all.surface += part.surface, all.overlap += part.overlap;
  return all.surface > 0.0 ? all.overlap / all.surface : 0.0;
}

}  // namespace strahl
