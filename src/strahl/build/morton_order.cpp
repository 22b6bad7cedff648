#include <algorithm>

#include <strahl/build/morton_order.h>
#include <strahl/build/object_split.h>
#include <strahl/math/morton.h>

namespace strahl {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 15;

void sort_halves(std::span<MortonPlace> places, const Executor& executor) {
  if (places.size() <= kGrain || executor.width() == 1)
    return std::sort(places.begin(), places.end());
  const auto middle = static_cast<std::ptrdiff_t>(places.size() / 2);
  executor.invoke([&] { sort_halves(places.first(places.size() / 2), executor); },
                  [&] { sort_halves(places.subspan(places.size() / 2), executor); });
  std::inplace_merge(places.begin(), places.begin() + middle, places.end());
}

}  // namespace

std::vector<MortonPlace> morton_order(std::span<const PrimRef> refs, const BuildContext& context) {
  context.check(0.0, "sorting");
  Aabb centers;
  for (const PrimRef& ref : refs) centers.extend(doubled_center(ref.box));
  const MortonFrame frame(centers);
  std::vector<MortonPlace> places(refs.size());
  context.executor.parallel_for(0, refs.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      places[i] = {frame.code(doubled_center(refs[i].box)), static_cast<std::uint32_t>(i)};
  });
  sort_halves(places, context.executor);
  return places;
}

}  // namespace strahl
