// apps/strahl/compare_text.h - results of `strahl compare` as JSON, CSV and Markdown.
#pragma once

#include <apps/strahl/session.h>
#include <string>

#include <strahl/measure/comparison.h>

namespace strahl::cli {

/// One scene's results; see docs/json/compare.schema.json.
Json to_json(const SceneComparison& comparison, const Scene& scene);

/// One line per scene, structure and workload.
std::string compare_csv(const Json& document);

/// Ranks per workload and one table per scene.
std::string compare_markdown(const Json& document);

}  // namespace strahl::cli
