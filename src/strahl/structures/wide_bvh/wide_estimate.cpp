#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/build/object_split.h>
#include <strahl/build/prim_ref.h>
#include <strahl/structures/wide_bvh/wide_estimate.h>

namespace strahl {
namespace {

constexpr std::size_t kPlaces = 8, kAtOnePlace = 2048;
/// What is cut above the neighbourhoods, where no sample sees it, as a part of what is cut in them:
/// 0.6 to 4 in the ten scenes of the README.
constexpr double kCutsAbove = 1.0;

/// Some things of a source, numbered anew.
class Neighbourhood final : public PrimitiveSource {
 public:
  Neighbourhood(const PrimitiveSource& whole, std::vector<std::uint32_t> things)
      : whole_(whole), things_(std::move(things)) {}
  std::uint32_t size() const override { return static_cast<std::uint32_t>(things_.size()); }
  Aabb bounds(std::uint32_t i) const override { return whole_.bounds(things_[i]); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return whole_.clip(things_[i], box);
  }
  bool triangle(std::uint32_t i, TriangleVertices& vertices) const override {
    return whole_.triangle(things_[i], vertices);
  }

 private:
  const PrimitiveSource& whole_;
  std::vector<std::uint32_t> things_;
};

/// Halves sets until there is one for each place, then follows one half of each.
class Sampler {
 public:
  Sampler(const PrimitiveSource& source, std::vector<PrimRef>& refs)
      : source_(source), splitter_(make_median_splitter(refs, MedianAxis::longest, {})) {}

  void visit(const ObjectSet& set, std::size_t places,
             const std::function<void(const Neighbourhood&)>& take) {
    if (set.size() <= kAtOnePlace) {
      std::vector<std::uint32_t> things;
      splitter_->list(set, things);
      return take(Neighbourhood(source_, std::move(things)));
    }
    const auto [left, right] = splitter_->divide(set, splitter_->find_median(set));
    if (places == 1) return visit(rng_.below(2) == 0 ? left : right, 1, take);
    visit(left, places / 2, take);
    visit(right, places / 2, take);
  }

 private:
  const PrimitiveSource& source_;
  std::unique_ptr<ObjectSplitter> splitter_;
  Rng rng_{1};
};

}  // namespace

std::uint64_t estimate_wide_bytes(const PrimitiveSource& source, const WideBvhOptions& options,
                                  const BuildContext& context) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  const std::size_t count = refs.size();
  if (count <= kPlaces * kAtOnePlace) return WideBvh(source, options, context).report().bytes;
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  double bytes = 0.0, references = 0.0, things = 0.0;
  Sampler(source, refs).visit({0, count, box, box}, kPlaces, [&](const Neighbourhood& near) {
    const BuildReport report = WideBvh(near, options, context).report();
    bytes += static_cast<double>(report.bytes - kWideSlack);
    references += static_cast<double>(report.references), things += near.size();
  });
  const double cuts = references / things - 1.0;
  const double each = bytes / references * (1.0 + (1.0 + kCutsAbove) * cuts);
  return static_cast<std::uint64_t>(std::llround(each * static_cast<double>(count))) + kWideSlack;
}

}  // namespace strahl
