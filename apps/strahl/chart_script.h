// apps/strahl/chart_script.h - charts as scripts for gnuplot, with their data inside, so that
// anyone can draw them anew or change them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace strahl::cli {

struct Chart {
  std::string name;    ///< of its files: letters, digits, underlines
  std::string title;   ///< for people
  std::string script;  ///< for gnuplot; writes NAME.svg
};

using Points = std::vector<std::pair<double, double>>;

/// In gnuplot's double quotes.
std::string quoted(const std::string& text);
/// Size, title, names of the axes.
std::string chart_head(const std::string& name, const std::string& title, const std::string& x,
                       const std::string& y);
/// Looks of series i, distinct for a few dozen.
std::string line_style(std::size_t i);
std::string point_style(std::size_t i);
/// Data block $d0, $d1, ...
std::string data_block(std::size_t i, const Points& points);
/// Some room on both sides of positive values, which one alone would not give.
std::string log_range(const char* axis, const std::vector<double>& values);

/// Writes NAME.gp and NAME.svg of each chart to the folder. False when there is no gnuplot: then
/// only scripts are written. Throws Error{resource} when a file cannot be written or gnuplot fails.
bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder);

}  // namespace strahl::cli
