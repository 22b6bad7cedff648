#include <algorithm>
#include <bit>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <tests/conformance/oracle.h>

namespace strahl::test {
namespace {

/// Rays [first, last) of a batch as a batch of their own.
RayBatch slice(RayBatch batch, std::size_t first, std::size_t last) {
  const auto cut = [&](auto& span) {
    if (!span.empty()) span = span.subspan(first, last - first);
  };
  for (VertexView* view : {&batch.org, &batch.dir}) {
    view->data += first * view->stride;
    view->count = last - first;
  }
  batch.t_min->data += first * batch.t_min->stride;
  batch.t_max->data += first * batch.t_max->stride;
  cut(batch.masks), cut(batch.excluded), cut(batch.after), cut(batch.cull_per_ray);
  return batch;
}

void ask_span(const Accelerator& accelerator, const RayBatch& rays, const BatchContext& context,
              int filtered, std::size_t first, Answers& out) {
  const std::size_t n = rays.size();
  const auto part = [&](auto& all) { return std::span(all).subspan(first, n); };
  out.invalid_rays +=
      accelerator.closest_hit(rays, part(out.closest[filtered]), context).invalid_rays;
  accelerator.any_hit(rays, part(out.any[filtered]), context);
  accelerator.count_hits(rays, part(out.counts[filtered]), context);
  AllHits all;
  accelerator.all_hits(rays, all, context);
  AllHits& sum = out.all[filtered];
  for (std::size_t i = 0; i < n; ++i)
    sum.splits.push_back(sum.splits.back() + all.splits[i + 1] - all.splits[i]);
  sum.hits.insert(sum.hits.end(), all.hits.begin(), all.hits.end());
  if (!filtered) accelerator.inside(rays, part(out.sides), context);
}

std::string describe(const Hit& hit) {
  std::ostringstream text;
  text << std::hexfloat << "t " << hit.t << " (" << hit.id.inst << ' ' << hit.id.geom << ' '
       << hit.id.prim << ") front " << hit.is_front;
  return text.str();
}

std::string differing_hit(const char* what, std::span<const Hit> got,
                          std::span<const Hit> expected) {
  if (got.size() != expected.size())
    return std::string(what) + ": " + std::to_string(got.size()) + " hits, expected " +
           std::to_string(expected.size());
  for (std::size_t i = 0; i < got.size(); ++i)
    if (!have_same_bits(got[i], expected[i]))
      return std::string(what) + " " + std::to_string(i) + ": " + describe(got[i]) + ", expected " +
             describe(expected[i]);
  return {};
}

template <class T>
std::string differing_number(const char* what, const std::vector<T>& got,
                             const std::vector<T>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (got[i] != expected[i])
      return std::string(what) + " of ray " + std::to_string(i) + ": " +
             std::to_string(static_cast<long long>(got[i])) + ", expected " +
             std::to_string(static_cast<long long>(expected[i]));
  return {};
}

}  // namespace

bool have_same_bits(const Hit& a, const Hit& b) {
  return std::bit_cast<std::uint64_t>(a.t) == std::bit_cast<std::uint64_t>(b.t) && a.id == b.id &&
         a.is_front == b.is_front && a.reference == b.reference;
}

Answers ask(const Accelerator& accelerator, const RaySet& set, const BuildContext& context,
            std::size_t span_size) {
  const std::size_t n = set.rays.size();
  if (span_size == 0) span_size = std::max<std::size_t>(n, 1);
  BatchContext batch_context;
  batch_context.context = context;
  Answers out;
  out.sides.resize(n);
  for (int filtered = 0; filtered < 2; ++filtered) {
    out.closest[filtered].resize(n), out.any[filtered].resize(n), out.counts[filtered].resize(n);
    out.all[filtered].splits.assign(1, 0);
    const RayBatch whole = set.batch(filtered != 0);
    for (std::size_t first = 0; first < n; first += span_size)
      ask_span(accelerator, slice(whole, first, std::min(n, first + span_size)), batch_context,
               filtered, first, out);
  }
  return out;
}

std::string first_difference(const Answers& got, const Answers& expected) {
  if (got.invalid_rays != expected.invalid_rays) return "number of invalid rays";
  for (int f = 0; f < 2; ++f) {
    const std::string kind = f ? "filtered " : "";
    for (const std::string& difference :
         {differing_hit("closest hit of ray", got.closest[f], expected.closest[f]),
          differing_number("any hit", got.any[f], expected.any[f]),
          differing_number("number of hits", got.counts[f], expected.counts[f]),
          differing_number("end of hits", got.all[f].splits, expected.all[f].splits),
          differing_hit("hit", got.all[f].hits, expected.all[f].hits)})
      if (!difference.empty()) return kind + difference;
  }
  std::vector<int> a, b;
  for (const Side s : got.sides) a.push_back(static_cast<int>(s));
  for (const Side s : expected.sides) b.push_back(static_cast<int>(s));
  return differing_number("side", a, b);
}

Expected expected_answers(const std::shared_ptr<const Scene>& scene, std::size_t rays,
                          std::uint64_t seed) {
  Expected e{adversarial_rays(*scene, rays, seed + rays), {}};
  const auto oracle = build(scene, "brute_force");
  std::vector<Hit> first(e.set.rays.size());
  oracle->closest_hit(e.set.batch(false), first);
  bind_filters(e.set, first, seed);
  e.answers = ask(*oracle, e.set, {});
  return e;
}

std::string first_difference(const std::shared_ptr<const Scene>& scene, const std::string& spec,
                             const Expected& expected) {
  const auto accelerator = build(scene, spec);
  try {
    accelerator->validate();
  } catch (const std::logic_error& broken) {
    return broken.what();
  }
  return first_difference(ask(*accelerator, expected.set, {}), expected.answers);
}

}  // namespace strahl::test
