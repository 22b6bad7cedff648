// strahl_bench_peer - the production path next to Embree: the same rays, interleaved, one thread.
//
//   strahl_bench_peer --build [--threads N] [--repeat N] SCENE...
//   strahl_bench_peer [--peer single|best] [--spec SPEC[,SPEC...]] [--size N] [--repeat N] SCENE...
//
// Prints per scene and workload the peer's Mrays/s and, for each SPEC, the median of the ratios of
// neighbouring runs with its 95 % interval. --size: pixels on a side, other sets have as many rays.
// --peer best: the peer's fastest interface for each workload, of single rays, packets of eight and
// streams, the latter two also called coherent. --build: times of builds only, of the peer's HIGH
// and MEDIUM and of wide_bvh's default and quality=fast.
#include <algorithm>
#include <apps/strahl/peer/embree_scene.h>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/measure/statistics.h>
#include <strahl/render/framing.h>

namespace strahl::peer {
namespace {

struct Options {
  std::vector<std::string> specs{"wide_bvh"}, scenes;
  int size = 512, repeat = 7;
  int threads = 1;  ///< of builds
  bool best_peer = false, build_only = false;
  std::string workload;  ///< the only one; all where empty
  std::string isa;       ///< the best that either side may use; any where empty
};

bool is_peer(std::string_view name) { return name == "single" || name == "best"; }

/// Throws Error{usage}.
Options parse(int argc, char** argv) {
  const std::string usage =
      "usage: strahl_bench_peer [--peer single|best] [--spec SPEC,...] [--size N] [--repeat N] "
      "[--workload NAME] [--isa avx512|avx2] SCENE...";
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto number = [&](int& value) {
      const char* text = ++i < argc ? argv[i] : "";
      const char* end = text + std::strlen(text);
      if (std::from_chars(text, end, value).ptr != end || value <= 0)
        throw Error(ErrorCode::usage, "needs a positive number\n" + usage, argument);
    };
    if (argument == "--size")
      number(options.size);
    else if (argument == "--repeat")
      number(options.repeat);
    else if (argument == "--threads")
      number(options.threads);
    else if (argument == "--build")
      options.build_only = true;
    else if (argument == "--isa" && i + 1 < argc)
      options.isa = argv[++i];
    else if (argument == "--workload" && i + 1 < argc)
      options.workload = argv[++i];
    else if (argument == "--spec" && i + 1 < argc)
      options.specs = split_specs(argv[++i]);
    else if (argument == "--peer" && i + 1 < argc && is_peer(argv[i + 1]))
      options.best_peer = std::string_view(argv[++i]) == "best";
    else if (argument.starts_with("--"))
      throw Error(ErrorCode::usage, "unknown option\n" + usage, argument);
    else
      options.scenes.push_back(argument);
  }
  if (options.scenes.empty()) throw Error(ErrorCode::usage, usage);
  return options;
}

/// CPU seconds of the calling thread: other programs on the machine disturb less than wall time.
class CpuTimer {
 public:
  CpuTimer() { clock_gettime(CLOCK_THREAD_CPUTIME_ID, &start_); }
  double seconds() const {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec - start_.tv_sec) +
           1e-9 * static_cast<double>(now.tv_nsec - start_.tv_nsec);
  }

 private:
  timespec start_;
};

/// One set of rays for both sides.
class Race {
 public:
  Race(const EmbreeScene& peer, std::span<const FloatRay> rays, bool any)
      : peer_(peer),
        rays_(rays),
        any_(any),
        results_(rays.size()),
        occluded_(rays.size()),
        own_occluded_(rays.size()),
        hits_(rays.size()) {}

  double run_peer() {
    const CpuTimer timer;
    any_ ? peer_.any(api_, rays_, occluded_) : peer_.closest(api_, rays_, results_);
    return timer.seconds();
  }
  /// From now on the interface whose best of three runs is the shortest.
  void choose_fastest() {
    double best = std::numeric_limits<double>::infinity();
    PeerApi fastest = api_;
    for (const PeerApi api : kPeerApis) {
      api_ = api;
      double seconds = run_peer();
      for (int i = 0; i < 2; ++i) seconds = std::min(seconds, run_peer());
      if (seconds < best) best = seconds, fastest = api;
    }
    api_ = fastest;
  }
  PeerApi api() const { return api_; }
  double run(const Accelerator& accelerator) {
    const RayBatch batch = batch_of(rays_);
    const CpuTimer timer;
    if (any_)
      accelerator.any_hit(batch, own_occluded_);
    else
      accelerator.closest_hit(batch, hits_);
    return timer.seconds();
  }

  /// Rays to which the last two runs of both sides gave different answers.
  std::size_t differences() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays_.size(); ++i)
      count += any_ ? occluded_[i] != own_occluded_[i]
                    : (results_[i].prim == RTC_INVALID_GEOMETRY_ID) == hits_[i].is_hit();
    return count;
  }

 private:
  const EmbreeScene& peer_;
  std::span<const FloatRay> rays_;
  bool any_;
  PeerApi api_ = PeerApi::single;
  std::vector<Result> results_;
  std::vector<std::uint8_t> occluded_, own_occluded_;
  std::vector<Hit> hits_;
};

using Ratios = std::map<std::string, std::vector<double>>;  ///< per SPEC or SPEC and workload

void race(const std::string& name, const Options& options, Ratios& all) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  std::vector<std::unique_ptr<Accelerator>> built;
  for (const std::string& spec : options.specs) built.push_back(build(scene, spec));
  const EmbreeScene peer(*scene, options.isa);
  const std::string label = name.substr(name.rfind('/') + 1);
  std::printf("%-22.22s %9u triangles; build s: peer %.3f", label.c_str(), scene->size(),
              peer.build_seconds());
  for (std::size_t s = 0; s < built.size(); ++s)
    std::printf(", %s %.3f (%.1f B/tri)", options.specs[s].c_str(), built[s]->report().seconds,
                static_cast<double>(built[s]->report().bytes) / scene->size());
  std::printf("\n");
  const auto count =
      static_cast<std::size_t>(options.size) * static_cast<std::size_t>(options.size);
  const WorkloadOptions wanted{default_view(*scene, options.size, options.size), count, 1};
  for (const WorkloadKind kind : kAllWorkloads) {
    if (kind == WorkloadKind::whitted) continue;  // asks for both kinds of hits
    if (!options.workload.empty() && options.workload != name_of(kind)) continue;
    const Workload workload = make_workload(kind, *built.front(), wanted);
    const bool is_any = workload.closest.empty();
    const std::vector<FloatRay> rays = float_rays(is_any ? workload.any : workload.closest);
    if (rays.empty()) continue;
    Race r(peer, rays, is_any);
    if (options.best_peer) r.choose_fastest();
    std::vector<std::vector<double>> theirs(built.size()), ours(built.size());
    for (int i = 0; i <= options.repeat; ++i) {
      for (std::size_t s = 0; s < built.size(); ++s) {
        const double peer_seconds = r.run_peer(), own_seconds = r.run(*built[s]);
        if (i == 0) continue;  // warms up
        theirs[s].push_back(peer_seconds), ours[s].push_back(own_seconds);
      }
    }
    std::printf("  %-8s %7zu rays  peer %6.2f M/s ", name_of(kind), rays.size(),
                1e-6 * static_cast<double>(rays.size()) / median(theirs.front()));
    for (std::size_t s = 0; s < built.size(); ++s) {
      const Estimate e = median_ratio(theirs[s], ours[s]);
      std::printf(" %6.3f [%.3f %.3f]", e.value, e.low, e.high);
      all[options.specs[s]].push_back(e.value);
      all[options.specs[s] + " " + name_of(kind)].push_back(e.value);
    }
    std::printf("  (%s, %zu differ)\n", name_of(r.api()), r.differences());
    std::fflush(stdout);
  }
}

/// Wall time where there are more threads, else processor time.
double peer_build(const Scene& scene, const Options& options, RTCBuildQuality quality) {
  const EmbreeScene peer(scene, options.isa, quality, options.threads);
  return options.threads > 1 ? peer.build_seconds() : peer.build_cpu_seconds();
}
double own_build(const std::shared_ptr<const Scene>& scene, const char* spec,
                 const Options& options) {
  BuildContext context;
  context.executor = Executor::with_threads(options.threads);
  const CpuTimer timer;
  const auto built = build(scene, spec, context);
  return options.threads > 1 ? built->report().seconds : timer.seconds();
}

/// Builds of both sides in turn; ratios are own over peer.
void race_builds(const std::string& name, const Options& options, Ratios& all) {
  struct Pair {
    const char* label;
    const char* spec;
    RTCBuildQuality quality;
  };
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  std::printf("%-24.24s %9u triangles", name.substr(name.rfind('/') + 1).c_str(), scene->size());
  for (const Pair& pair :
       {Pair{"default / HIGH", "wide_bvh", RTC_BUILD_QUALITY_HIGH},
        Pair{"fast / MEDIUM", "wide_bvh:quality=fast", RTC_BUILD_QUALITY_MEDIUM}}) {
    std::vector<double> theirs, ours;
    for (int i = 0; i <= options.repeat; ++i) {
      const double peer = peer_build(*scene, options, pair.quality);
      const double own = own_build(scene, pair.spec, options);
      if (i > 0) theirs.push_back(peer), ours.push_back(own);
    }
    const Estimate e = median_ratio(ours, theirs);
    std::printf("; %s: %.3f s / %.3f s = %.2f [%.2f %.2f]", pair.label, median(ours),
                median(theirs), e.value, e.low, e.high);
    all[pair.label].push_back(e.value);
  }
  std::printf("\n");
  std::fflush(stdout);
}

int run(const Options& options) {
  if (!options.isa.empty()) ::setenv("STRAHL_ISA", options.isa.c_str(), 1);
  Ratios all;
  for (const std::string& scene : options.scenes)
    options.build_only ? race_builds(scene, options, all) : race(scene, options, all);
  std::printf("geometric means of the ratios\n");
  for (const auto& [what, ratios] : all) {
    double sum = 0.0;
    for (const double r : ratios) sum += std::log(r);
    std::printf("  %-40s %6.3f\n", what.c_str(),
                std::exp(sum / static_cast<double>(ratios.size())));
  }
  return 0;
}

}  // namespace
}  // namespace strahl::peer

int main(int argc, char** argv) {
  try {
    return strahl::peer::run(strahl::peer::parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "strahl_bench_peer: %s\n", error.what());
    return 2;
  }
}
