// apps/strahl/main.cpp - the command line: parses, runs the chosen subcommand, maps errors to exit
// codes.
#include <apps/strahl/commands.h>
#include <apps/strahl/interrupt.h>
#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

#include <fmt/core.h>

namespace {

using namespace strahl;       // NOLINT(google-build-using-namespace): this file is the program
using namespace strahl::cli;  // NOLINT(google-build-using-namespace)

void print_error(const char* message) { fmt::print(stderr, "strahl: error: {}\n", message); }

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
    case ErrorCode::unsupported:
      return kExitUsage;
    case ErrorCode::bad_input:
      return kExitBadInput;
    case ErrorCode::cancelled:
      return interrupt_signal() != 0 ? 128 + interrupt_signal() : kExitResource;
    case ErrorCode::resource:
      break;
  }
  return kExitResource;
}

/// Runs and turns whatever is thrown into a message and an exit code.
int guarded(const Runner& run) {
  try {
    const int code = run();
    return interrupt_signal() != 0 ? 128 + interrupt_signal() : code;
  } catch (const Error& error) {
    print_error(error.code() == ErrorCode::cancelled ? "interrupted" : error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return kExitResource;
  } catch (const std::logic_error& error) {
    // validate() reports a broken invariant this way.
    print_error(error.what());
    return kExitCheckFailed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kExitResource;
  }
}

void describe(CLI::App& app) {
  app.name("strahl");
  app.description("strahl - exact ray queries against geometry");
  app.footer(
      "Examples:\n"
      "  strahl list\n"
      "  strahl info bunny.ply --structure kd_tree\n"
      "  strahl render gen:balls:4 -o balls.png\n"
      "  strahl query bunny.ply --rays rays.npy -o hits.npz\n"
      "'strahl COMMAND --help' explains a command.\n"
      "Exit codes: 0 ok, 1 check failed, 2 usage, 3 bad input, 4 resource or cancelled, 130 "
      "Ctrl-C.");
  app.set_help_flag("-h,--help", "Print this help");
  app.get_formatter()->column_width(34);
}

int run_command(int argc, char** argv) {
  CLI::App app;
  describe(app);
  bool version = false, verbose = false;
  app.add_flag("--version", version, "Print the version");
  app.add_flag("--verbose", verbose, "With --version: commit, instruction set, dependencies");
  Runner run;
  for (const auto add : {add_list_command, add_info_command, add_check_command, add_render_command,
                         add_query_command, add_generate_command, add_compare_command,
                         add_advise_command, add_bench_command})
    add(app, run);
  app.require_subcommand(0, 1);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    print_error(error.what());
    fmt::print(stderr, "'strahl --help' and 'strahl COMMAND --help' explain the arguments\n");
    return kExitUsage;
  }
  if (version) run = [=] { return print_text(version_text(verbose)), kExitOk; };
  if (!run) {
    fmt::print(stderr, "{}", app.help());
    return kExitUsage;
  }
  return run();
}

}  // namespace

int main(int argc, char** argv) {
  catch_interrupts();
  return guarded([&] { return run_command(argc, argv); });
}
