// apps/strahl/compare_summary.h - what a comparison says over all its scenes.
#pragma once

#include <apps/strahl/session.h>
#include <string>

namespace strahl::cli {

/// Per workload: mean ranks with their tests, times relative to the first structure, worst cases.
/// @param scenes as in the document of `strahl compare`, each with the same structures
Json compare_summary(const Json& scenes);

/// One table per workload.
std::string summary_markdown(const Json& summary);

}  // namespace strahl::cli
