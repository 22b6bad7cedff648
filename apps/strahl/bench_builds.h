// apps/strahl/bench_builds.h - own builds beside those of the peer that are meant for the same: the
// default beside its HIGH, quality=fast beside its MEDIUM, and how fast the trees of both are
// traced.
#pragma once

#include <apps/strahl/bench_setup.h>

namespace strahl::cli {

/// Loads and builds one scene again and again; adds to "builds" of the document.
void race_builds(const std::string& name, const BenchOptions& options, Session& session,
                 Json& document);

/// Geometric means per SPEC.
Json builds_summary(const Json& builds);

/// "builds" and "builds_summary" as a table.
std::string builds_markdown(const Json& document);

}  // namespace strahl::cli
