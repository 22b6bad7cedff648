// apps/strahl/compare_page.h - a comparison as one HTML file that needs nothing else.
#pragma once

#include <apps/strahl/compare_charts.h>

namespace strahl::cli {

/// Ranks, tables, charts and heat maps; pictures are read from the folder and put into the page.
/// Charts without an SVG file are left out.
std::string compare_page(const Json& document, const std::vector<Chart>& charts,
                         const std::filesystem::path& folder);

}  // namespace strahl::cli
