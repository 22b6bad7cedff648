// apps/strahl/compare_charts.h - charts of a comparison.
#pragma once

#include <apps/strahl/chart_script.h>
#include <apps/strahl/session.h>
#include <vector>

namespace strahl::cli {

/// Per workload: time over scene size, mean ranks, memory against speed; per scene: total time over
/// the number of rays, building included.
std::vector<Chart> compare_charts(const Json& document);

}  // namespace strahl::cli
