// apps/strahl/compare_charts.h - charts of a comparison, drawn by gnuplot.
//
// Each chart is a script with its data inside, so that anyone can draw it anew or change it.
#pragma once

#include <apps/strahl/session.h>
#include <filesystem>
#include <string>
#include <vector>

namespace strahl::cli {

struct Chart {
  std::string name;    ///< of its files: letters, digits, underlines
  std::string title;   ///< for people
  std::string script;  ///< for gnuplot; writes NAME.svg
};

/// Per workload: time over scene size, mean ranks, memory against speed; per scene: total time over
/// the number of rays, building included.
std::vector<Chart> compare_charts(const Json& document);

/// Writes NAME.gp and NAME.svg of each chart to the folder. False when there is no gnuplot: then
/// only scripts are written. Throws Error{resource} when a file cannot be written or gnuplot fails.
bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder);

}  // namespace strahl::cli
