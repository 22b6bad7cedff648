// structures/bih/bih_validate.h - the invariants of a bounding interval hierarchy, executable.
#pragma once

#include <strahl/build/build_report.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/bih/bih_node.h>

namespace strahl {

/// Throws std::logic_error naming the first broken invariant of bih.h. O(nodes + references).
void validate_bih(const BihArrays& tree, const Aabb& root, const BuildReport& report,
                  const PrimitiveSource& source);

}  // namespace strahl
