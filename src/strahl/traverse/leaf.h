// traverse/leaf.h - tests the references of a leaf or cell; every structure ends here.
#pragma once

#include <cstdint>
#include <span>

#include <strahl/math/ray.h>

namespace strahl {

/// Visits the references in order. True when the query stops the traversal.
/// Always inlined: every loop of a structure calls it, which makes compilers think it large.
/// @param prims has visit(reference, ray, query, counters) -> stop
template <class Prims, class Q, class C>
[[gnu::always_inline]] inline bool test_references(std::span<const std::uint32_t> references,
                                                   Prims& prims, const PreparedRay& ray, Q& query,
                                                   C& counters) {
  for (const std::uint32_t reference : references)
    if (prims.visit(reference, ray, query, counters)) return true;
  return false;
}

/// The same, counted as a leaf.
template <class Prims, class Q, class C>
bool test_leaf(std::span<const std::uint32_t> references, Prims& prims, const PreparedRay& ray,
               Q& query, C& counters) {
  counters.leaf_entered(references.empty());
  return test_references(references, prims, ray, query, counters);
}

}  // namespace strahl
