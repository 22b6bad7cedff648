// strahl_leaks - prints how many rays leak out of a closed mesh, are counted more than once or end
// on the wrong side, for every structure or one SPEC and, where it is installed, for Embree 3.
//
// Exit status: 1 when any structure of strahl gets any ray wrong, 2 for a bad command line.
#include <algorithm>
#include <bench/leak_cases.h>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>
#ifdef STRAHL_HAVE_EMBREE
#include <bench/leaks_embree.h>
#endif

namespace strahl::leaks {
namespace {

constexpr std::size_t kBruteForceRays = 10000;

struct Options {
  std::size_t rays = 1000000;
  int threads = 1;
  std::vector<std::string> specs;  ///< to test; all structures unless one is asked for
  bool is_json = false;
};

std::vector<std::string> names_of_structures() {
  std::vector<std::string> names;
  for (const StructureEntry& entry : all_structures()) names.emplace_back(entry.name);
  return names;
}

/// Throws Error{usage}.
Options parse(int argc, char** argv) {
  const std::string usage =
      "usage: strahl_leaks [--rays N] [--threads N] [--structure SPEC] [--json]";
  Options options;
  const auto number = [&](int i, auto& value) {
    const char* end = i < argc ? argv[i] + std::strlen(argv[i]) : nullptr;
    if (end == nullptr || std::from_chars(argv[i], end, value).ptr != end || value <= 0)
      throw Error(ErrorCode::usage, "needs a positive number\n" + usage, argv[i - 1]);
  };
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json")
      options.is_json = true;
    else if (argument == "--rays")
      number(++i, options.rays);
    else if (argument == "--threads")
      number(++i, options.threads);
    else if (argument == "--structure" && i + 1 < argc)
      options.specs = {argv[++i]};
    else
      throw Error(ErrorCode::usage, "unknown option\n" + usage, argument);
  }
  if (options.specs.empty()) options.specs = names_of_structures();
  return options;
}

/// Prints rows as they come, as a table or as a JSON array.
class Table {
 public:
  explicit Table(bool is_json) : is_json_(is_json) {
    if (is_json_)
      std::printf("[");
    else
      std::printf("%-16s %-14s %-15s %9s %9s %12s %14s\n", "engine", "sphere", "aimed at", "rays",
                  "leaks", "wrong counts", "wrong parities");
  }
  ~Table() {
    if (is_json_) std::printf("\n]\n");
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  void row(const std::string& engine, const Sphere& sphere, Aim aim, const Tally& t) {
    const char* format =
        is_json_ ? "%s\n  {\"engine\": \"%s\", \"sphere\": \"%s\", \"aimed_at\": \"%s\", \"rays\": "
                   "%llu, \"leaks\": %llu, \"wrong_counts\": %llu, \"wrong_parities\": %llu}"
                 : "%s%-16s %-14s %-15s %9llu %9llu %12llu %14llu\n";
    using Number = unsigned long long;
    std::printf(format, is_json_ && rows_ > 0 ? "," : "", engine.c_str(), sphere.name, name_of(aim),
                Number{t.rays}, Number{t.leaks}, Number{t.wrong_counts}, Number{t.wrong_parities});
    std::fflush(stdout);
    ++rows_;
  }

 private:
  bool is_json_;
  int rows_ = 0;
};

/// Whether every structure answered every ray rightly.
bool test_sphere(const Sphere& sphere, const Options& options, Table& table) {
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh_of(sphere);
  const auto scene = std::make_shared<const Scene>(std::move(data));
  const TriangleMesh& mesh = scene->geometries().front().mesh;
  BatchContext context;
  context.context.executor = Executor::with_threads(options.threads);
  bool is_clean = true;
  for (const std::string& spec : options.specs) {
    const auto accelerator = build(scene, spec);
    const bool is_brute = accelerator->spec() == "brute_force";
    for (const Aim aim : kAims) {
      const std::size_t count = is_brute ? std::min(options.rays, kBruteForceRays) : options.rays;
      const Tally sum = tally(*accelerator, make_rays(sphere, mesh, aim, count), context);
      table.row(spec, sphere, aim, sum);
      is_clean = is_clean && sum.is_clean();
    }
  }
#ifdef STRAHL_HAVE_EMBREE
  for (const bool is_robust : {false, true}) {
    const EmbreeScene embree(mesh, is_robust);
    for (const Aim aim : kAims)
      table.row(is_robust ? "embree robust" : "embree default", sphere, aim,
                embree.tally(make_rays(sphere, mesh, aim, options.rays)));
  }
#endif
  return is_clean;
}

int run(const Options& options) {
  Table table(options.is_json);
  bool is_clean = true;
  for (const Sphere& sphere : kSpheres) is_clean = test_sphere(sphere, options, table) && is_clean;
  return is_clean ? 0 : 1;
}

}  // namespace
}  // namespace strahl::leaks

int main(int argc, char** argv) {
  try {
    return strahl::leaks::run(strahl::leaks::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "strahl_leaks: %s\n", error.what());
    return 2;
  }
}
