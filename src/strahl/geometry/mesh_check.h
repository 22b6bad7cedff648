// geometry/mesh_check.h - mesh doctor: what is wrong with the primitives of a scene.
//
// Vertices count as one where their coordinates are equal as numbers (-0 equals 0). Triangles with
// a repeated or non-finite vertex take no part in the checks of edges and duplicates.
// Thread safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

enum class MeshDefect {
  zero_area,             ///< three different vertices on a line; never hit
  repeated_vertex,       ///< two corners at one position; never hit
  not_finite,            ///< a corner is NaN or infinite; never hit
  out_of_range,          ///< an index without vertex, or a magnitude outside 2^-240..2^240
  duplicate_triangle,    ///< the same three positions as an earlier triangle, in any order
  non_manifold_edge,     ///< an edge of three or more triangles
  open_edge,             ///< an edge of one triangle
  inconsistent_winding,  ///< an edge of two triangles that run along it in the same direction
  invalid_curved,        ///< a sphere or cone that can never be hit
};
inline constexpr int kMeshDefects = 9;

/// "zero_area" and so on.
std::string_view name_of(MeshDefect defect);

/// All cases of one defect in one geometry.
struct MeshFinding {
  MeshDefect defect;
  std::uint64_t count = 0;
  /// The first cases: primitive ids in ascending order; for edges the first triangle of each.
  std::vector<std::uint64_t> first;
};

/// The findings of one geometry, in the order of MeshDefect, at most `keep` first cases each.
/// A sound geometry has none. O(n log n) time, O(n) memory.
std::vector<MeshFinding> check_mesh(const Geometry& geometry, std::size_t keep = 10);

}  // namespace strahl
