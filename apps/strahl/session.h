// apps/strahl/session.h - what every subcommand shares: common options, loading, news, output.
//
// Thread safety: one thread; the contexts it makes may be used by tasks.
#pragma once

#include <apps/strahl/progress.h>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <nlohmann/json.hpp>

#include <strahl/catalog/accelerator.h>
#include <strahl/geometry/scene.h>
#include <strahl/io/deform.h>
#include <strahl/measure/advisor.h>

namespace strahl::cli {

using Json = nlohmann::ordered_json;

inline constexpr int kExitOk = 0, kExitCheckFailed = 1, kExitUsage = 2, kExitBadInput = 3,
                     kExitResource = 4;

/// The chosen subcommand, set while the arguments are parsed; returns the exit code.
using Runner = std::function<int()>;

/// Options of all subcommands.
struct CommonOptions {
  bool json = false, quiet = false;
  int threads = 0;     ///< 0: all cores
  std::string memory;  ///< "" or a number of bytes with K, M, G
};

/// Adds --json, --quiet.
void add_output_options(CLI::App& command, CommonOptions& options);
/// Adds these, --threads and --memory.
void add_common_options(CLI::App& command, CommonOptions& options);

/// One run of a subcommand.
class Session {
 public:
  /// Throws Error{usage} for a malformed --memory.
  explicit Session(const CommonOptions& options);

  /// Executor, memory limit, and a progress callback that draws the bar and stops on Ctrl-C.
  const BuildContext& context() const { return context_; }

  /// Reads or generates a scene; warnings go to stderr. Throws Error.
  SceneData load_data(const std::string& scene);
  /// The same, checked and frozen. Geometry g of the file is seen by rays whose mask has bit
  /// g mod 32.
  std::shared_ptr<const Scene> load(const std::string& scene);
  /// The data with all that can move them, masked likewise.
  RiggedScene load_rigged(const std::string& scene);
  /// The SPEC as it is, or for "auto" the advisor's for the rays to come; says so on stderr.
  std::string chosen_spec(const std::shared_ptr<const Scene>& scene, const std::string& spec,
                          const AdviceOptions& rays_to_come);
  /// Builds what chosen_spec() says.
  std::unique_ptr<Accelerator> build(std::shared_ptr<const Scene> scene, const std::string& spec,
                                     const AdviceOptions& rays_to_come = {});

  /// "strahl: warning: ..." on stderr unless --quiet.
  void warn(const std::string& text);
  /// "strahl: ..." on stderr unless --quiet: where a long run is.
  void note(const std::string& text);
  /// Removes the progress bar: call before printing results.
  void finish_progress() { bar_.clear(); }

 private:
  void take(SceneData& data, const std::string& scene);

  bool quiet_;
  ProgressBar bar_;
  BuildContext context_;
};

/// Prints to stdout. Throws Error{resource} when stdout cannot take it.
void print_text(const std::string& text);
/// One JSON document, two blanks of indentation, and a line end.
void print_json(const Json& json);

/// [x, y, z]
Json to_json(const Vec3d& v);
/// {"min": [...], "max": [...]}, null for an empty box.
Json to_json(const Aabb& box);
Json to_json(const BuildReport& report);
/// null where there is none.
Json to_json(const std::optional<double>& value);
Json to_json(const Counters& counters);

}  // namespace strahl::cli
