// apps/strahl/bench_worst.h - what exactness may cost: rays through vertices beside rays through
// the inside of triangles, and vertices that are no floats beside such that are.
#pragma once

#include <apps/strahl/bench_mesh.h>
#include <apps/strahl/bench_setup.h>

namespace strahl::cli {

/// Rays from the same origins to a corner of a triangle, and to somewhere inside it.
struct AimedRays {
  RaySet to_vertices, to_insides;
};

/// Up to `count` pairs whose first ray meets nothing before its vertex, and meets it exactly:
/// org + dir is the vertex without rounding.
/// @param mesh of the accelerator; its vertices are multiples of `step`, a coarse_step()
AimedRays make_aimed_rays(const Accelerator& accelerator, const FlatMesh& mesh, double step,
                          std::size_t count, std::uint64_t seed);

/// Both on a copy of the scene whose vertices are snapped to a coarse grid; adds to "worst".
/// Most that is asked for: 3 times as long.
void measure_worst(const std::string& name, const BenchOptions& options, Session& session,
                   Json& document);

/// The scene with vertices of float64 beside the same with float32, same rays; adds to "doubles".
/// Most that is asked for: 1.35 times as long.
void measure_doubles(const std::string& name, const BenchOptions& options, Session& session,
                     Json& document);

/// Geometric means over the scenes per way of handing over.
Json means_of_apis(const Json& rows);

std::string worst_markdown(const Json& document);
std::string doubles_markdown(const Json& document);

}  // namespace strahl::cli
