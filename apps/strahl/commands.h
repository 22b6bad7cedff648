// apps/strahl/commands.h - the subcommands: each adds itself to the parser and sets `run`.
#pragma once

#include <apps/strahl/session.h>

namespace strahl::cli {

void add_list_command(CLI::App& app, Runner& run);
void add_info_command(CLI::App& app, Runner& run);
void add_check_command(CLI::App& app, Runner& run);
void add_render_command(CLI::App& app, Runner& run);
void add_query_command(CLI::App& app, Runner& run);
void add_generate_command(CLI::App& app, Runner& run);
void add_compare_command(CLI::App& app, Runner& run);
void add_advise_command(CLI::App& app, Runner& run);
void add_bench_command(CLI::App& app, Runner& run);

/// What SCENE may be, for the help of a subcommand.
inline constexpr const char* kSceneHelp =
    "A file (PLY, OBJ, STL, OFF, glTF, GLB, NFF) or gen:NAME[:SIZE[,key=value...]]";
inline constexpr const char* kSpecHelp =
    "Structure: NAME[:option=value,...], see 'strahl list', or auto (default: wide_bvh)";

/// "0.1.0", or with `verbose` also commit, instruction set, threads and dependencies.
std::string version_text(bool verbose);

}  // namespace strahl::cli
