// apps/strahl/bench_scaling.h - how build, memory and time per ray grow with the number of
// triangles, on one generated scene in many sizes.
//
// One structure at a time is in memory, so that the largest sizes fit: what is compared here runs
// one after the other, not in turn.
#pragma once

#include <apps/strahl/bench_setup.h>
#include <apps/strahl/chart_script.h>

namespace strahl::cli {

/// The generator's text for about `triangles` triangles: "gen:terrain:72". Throws Error{usage} for
/// one that has no sizes to choose from.
std::string scaled_scene(const std::string& generator, double triangles);

/// from, from * step, ... below `to`, and `to`. Throws Error{usage} unless 1 <= from <= to and
/// step > 1.
std::vector<double> scaled_sizes(double from, double to, double step);

/// Rows of all sizes, see docs/json/bench.schema.json.
Json measure_scaling(const BenchOptions& options, Session& session);

std::string scaling_markdown(const Json& rows);

/// Time per ray of each workload, build time and memory per triangle over the number of triangles.
std::vector<Chart> scaling_charts(const Json& rows);

}  // namespace strahl::cli
