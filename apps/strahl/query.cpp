// apps/strahl/query.cpp - `strahl query`: rays from a file, answers into a file.
//
// Rays stay in the mapped file; answers are written chunk by chunk into their final arrays, so that
// memory is that of rays, answers and structure.
#include <algorithm>
#include <apps/strahl/commands.h>
#include <apps/strahl/interrupt.h>
#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/base/timer.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/hit_file.h>
#include <strahl/io/ray_file.h>
#include <strahl/measure/comparison.h>

namespace strahl::cli {
namespace {

/// Rays per call; enough for many threads, few enough that the hits in flight do not count.
constexpr std::size_t kChunk = 65536;
constexpr std::size_t kGrain = 1024;

constexpr std::array<std::pair<std::string_view, QueryKind>, 5> kKinds{
    {{"closest", QueryKind::closest},
     {"any", QueryKind::any},
     {"all", QueryKind::all},
     {"count", QueryKind::count},
     {"inside", QueryKind::inside}}};

struct QueryOptions : CommonOptions {
  std::string scene, spec{kDefaultSpec}, query = "closest", output;
  std::string rays, masks, excluded, after;
  bool cull = false, count = false;
};

/// What came of a query besides its arrays.
struct Outcome {
  std::uint64_t hits = 0, hash = 0;
  BatchReport report;
  double trace_seconds = 0.0;
};

/// One query over all rays of a file.
class QueryRun {
 public:
  QueryRun(const Accelerator& accelerator, const RayFile& rays, const QueryOptions& options,
           const BuildContext& context)
      : accelerator_(accelerator), rays_(rays), options_(options), context_(context) {}

  /// Traces and writes the file if there is a name.
  Outcome run(QueryKind kind) {
    switch (kind) {
      case QueryKind::closest:
        closest();
        break;
      case QueryKind::all:
        all();
        break;
      case QueryKind::any:
        scalars<std::uint8_t>("occluded", &Accelerator::any_hit);
        break;
      case QueryKind::count:
        scalars<std::uint32_t>("counts", &Accelerator::count_hits);
        break;
      case QueryKind::inside:
        inside();
        break;
    }
    return outcome_;
  }

 private:
  /// Calls trace(first, chunk, batch context) for all chunks and adds up reports and time.
  template <class Trace>
  void for_chunks(Trace trace) {
    RayFile::Chunk chunk;
    const Timer timer;
    for (std::size_t first = 0; first < rays_.size(); first += kChunk) {
      rays_.load(first, std::min(kChunk, rays_.size() - first), chunk);
      chunk.rays.cull_back = options_.cull;
      const BatchReport part = trace(first, chunk.rays, chunk_context(first));
      outcome_.report.invalid_rays += part.invalid_rays;
      outcome_.report.counters += part.counters;
    }
    outcome_.trace_seconds = timer.seconds();
  }

  /// Progress of a chunk becomes progress of the whole.
  BatchContext chunk_context(std::size_t first) const {
    BatchContext batch{context_, options_.count};
    const auto total = static_cast<double>(rays_.size());
    const double done = static_cast<double>(first) / total;
    const double share = static_cast<double>(std::min(kChunk, rays_.size() - first)) / total;
    batch.context.progress = [this, done, share](double fraction, std::string_view stage) {
      return context_.progress(done + share * fraction, stage);
    };
    return batch;
  }

  void require_memory(std::uint64_t items, std::uint64_t bytes_each) const {
    context_.require_memory(accelerator_.report().bytes + items * bytes_each, "structure and hits");
  }

  void closest();
  void all();
  /// Surfaces of the hits of one chunk of `all`, whose first ray is `first`.
  void fill(std::size_t first, const std::vector<Hit>& hits, const RawArray<std::int64_t>& splits,
            HitArrays& arrays, RawArray<std::uint32_t>& ray_ids) const;
  void inside();

  /// Queries with one number per ray; positive ones count as hits.
  template <class T, class Query>
  void scalars(const char* name, Query query) {
    require_memory(rays_.size(), sizeof(T));
    RawArray<T> answers(rays_.size());
    for_chunks([&](std::size_t first, const RayBatch& rays, const BatchContext& batch) {
      return (accelerator_.*query)(rays, answers.span().subspan(first, rays.size()), batch);
    });
    for (const T answer : answers.span()) outcome_.hits += answer > 0 ? 1u : 0u;
    Hash64 hash;
    hash.add(std::as_const(answers).span());
    outcome_.hash = hash.digest();
    write([&](NpzWriter& file) { file.add(name, npy_array(std::as_const(answers).span())); });
  }

  void write(const std::function<void(NpzWriter&)>& add_arrays) const {
    if (options_.output.empty()) return;
    context_.check(1.0, "writing");
    const OwnsOutput owns_output;
    NpzWriter file(options_.output);
    add_arrays(file);
    file.close(context_.progress);
  }

  const Accelerator& accelerator_;
  const RayFile& rays_;
  const QueryOptions& options_;
  const BuildContext& context_;
  Outcome outcome_;
};

void QueryRun::closest() {
  require_memory(rays_.size(), kHitArrayBytes);
  HitArrays arrays(rays_.size());
  std::vector<Hit> hits;
  for_chunks([&](std::size_t first, const RayBatch& rays, const BatchContext& batch) {
    hits.resize(rays.size());
    const BatchReport part = accelerator_.closest_hit(rays, hits, batch);
    context_.executor.parallel_for(0, hits.size(), kGrain, [&](std::size_t i, std::size_t end) {
      for (; i < end; ++i) arrays.set(first + i, accelerator_.scene(), rays.ray(i), hits[i]);
    });
    for (const Hit& hit : hits) outcome_.hits += hit.is_hit();
    return part;
  });
  outcome_.hash = arrays.hash();
  write([&](NpzWriter& file) { arrays.add_to(file); });
}

void QueryRun::inside() {
  require_memory(rays_.size(), sizeof(Side));
  RawArray<std::int8_t> answers(rays_.size());
  std::vector<Side> sides;
  for_chunks([&](std::size_t first, const RayBatch& rays, const BatchContext& batch) {
    sides.resize(rays.size());
    const BatchReport part = accelerator_.inside(rays, sides, batch);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      answers[first + i] = static_cast<std::int8_t>(sides[i]);
      outcome_.hits += sides[i] == Side::inside;
    }
    return part;
  });
  Hash64 hash;
  hash.add(std::as_const(answers).span());
  outcome_.hash = hash.digest();
  write([&](NpzWriter& file) { file.add("inside", npy_array(std::as_const(answers).span())); });
}

void QueryRun::all() {
  RawArray<std::int64_t> splits(rays_.size() + 1);
  splits[0] = 0;
  std::vector<std::vector<Hit>> parts;
  AllHits found;
  for_chunks([&](std::size_t first, const RayBatch& rays, const BatchContext& batch) {
    const BatchReport part = accelerator_.all_hits(rays, found, batch);
    for (std::size_t i = 0; i < rays.size(); ++i)
      splits[first + i + 1] = splits[first] + found.splits[i + 1];
    outcome_.hits += found.hits.size();
    require_memory(outcome_.hits, sizeof(Hit) + kHitArrayBytes + sizeof(std::uint32_t));
    parts.emplace_back(found.hits.begin(), found.hits.end());
    return part;
  });

  HitArrays arrays(outcome_.hits);
  RawArray<std::uint32_t> ray_ids(outcome_.hits);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    fill(p * kChunk, parts[p], splits, arrays, ray_ids);
    std::vector<Hit>().swap(parts[p]);
    context_.check(static_cast<double>(p + 1) / static_cast<double>(parts.size()), "surfaces");
  }
  Hash64 hash;
  hash.add(arrays.hash());
  hash.add(std::as_const(ray_ids).span());
  hash.add(std::as_const(splits).span());
  outcome_.hash = hash.digest();
  write([&](NpzWriter& file) {
    arrays.add_to(file);
    file.add("ray_ids", npy_array(std::as_const(ray_ids).span()));
    file.add("ray_splits", npy_array(std::as_const(splits).span()));
  });
}

void QueryRun::fill(std::size_t first, const std::vector<Hit>& hits,
                    const RawArray<std::int64_t>& splits, HitArrays& arrays,
                    RawArray<std::uint32_t>& ray_ids) const {
  RayFile::Chunk chunk;
  rays_.load(first, std::min(kChunk, rays_.size() - first), chunk);
  const auto begin = static_cast<std::size_t>(splits[first]);
  const auto fill_rays = [&](std::size_t i, std::size_t end) {
    for (; i < end; ++i) {
      const Ray ray = chunk.rays.ray(i);
      const auto last = static_cast<std::size_t>(splits[first + i + 1]);
      for (auto k = static_cast<std::size_t>(splits[first + i]); k < last; ++k) {
        arrays.set(k, accelerator_.scene(), ray, hits[k - begin]);
        ray_ids[k] = static_cast<std::uint32_t>(first + i);
      }
    }
  };
  context_.executor.parallel_for(0, chunk.rays.size(), kGrain, fill_rays);
}

QueryKind query_kind(const std::string& name) {
  for (const auto& [word, kind] : kKinds)
    if (word == name) return kind;
  throw Error(ErrorCode::usage, "unknown query '" + name + "'; known: closest any all count inside",
              "--query");
}

void check_output(const QueryOptions& options) {
  if (options.output.empty()) {
    if (options.json) return;
    throw Error(ErrorCode::usage, "needed, or --json to only measure", "--output");
  }
  const std::filesystem::path folder = std::filesystem::path(options.output).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw Error(ErrorCode::resource, "no such folder", folder.string());
}

Json report(const QueryOptions& options, const Accelerator& accelerator, std::size_t rays,
            const Outcome& outcome) {
  const double seconds = outcome.trace_seconds;
  Json json = {
      {"scene", options.scene},
      {"scene_hash", to_hex(accelerator.scene().hash())},
      {"structure", accelerator.spec()},
      {"query", options.query},
      {"rays", rays},
      {"hits", outcome.hits},
      {"invalid_rays", outcome.report.invalid_rays},
      {"result_hash", to_hex(outcome.hash)},
      {"build_seconds", accelerator.report().seconds},
      {"trace_seconds", seconds},
      {"mrays_per_second", seconds > 0.0 ? static_cast<double>(rays) / seconds * 1e-6 : 0.0}};
  if (options.count) json["counters"] = to_json(outcome.report.counters);
  json["output"] = options.output.empty() ? Json(nullptr) : Json(options.output);
  return json;
}

/// Some of the rays, for the advisor.
Workload sample_of(const RayFile& rays, QueryKind kind) {
  constexpr std::size_t kSample = 2048;
  Workload sample;
  std::vector<Ray>& some = kind == QueryKind::any ? sample.any : sample.closest;
  RayFile::Chunk chunk;
  for (const std::size_t i : spread_blocks(rays.size(), kSample)) {
    rays.load(i, 1, chunk);
    some.push_back(chunk.rays.ray(0));
  }
  return sample;
}

std::unique_ptr<Accelerator> build_for(const RayFile& rays, QueryKind kind,
                                       const QueryOptions& options, Session& session) {
  const std::shared_ptr<const Scene> scene = session.load(options.scene);
  const Workload sample = sample_of(rays, kind);
  AdviceOptions rays_to_come;
  rays_to_come.rays = static_cast<double>(rays.size()), rays_to_come.sample = &sample;
  return session.build(scene, options.spec, rays_to_come);
}

int run_query(const QueryOptions& options) {
  const QueryKind kind = query_kind(options.query);
  check_output(options);
  const RayFile rays({options.rays, options.masks, options.excluded, options.after});
  Session session(options);
  if (kind == QueryKind::all && rays.size() > 0xffffffffu)
    throw Error(ErrorCode::resource, "more than 2^32 - 1 rays", options.rays);
  const std::unique_ptr<Accelerator> accelerator = build_for(rays, kind, options, session);
  const Outcome outcome = QueryRun(*accelerator, rays, options, session.context()).run(kind);
  session.finish_progress();
  if (outcome.report.invalid_rays > 0)
    session.warn(
        fmt::format("{}: {} invalid rays hit nothing", options.rays, outcome.report.invalid_rays));
  const Json json = report(options, *accelerator, rays.size(), outcome);
  if (options.json)
    print_json(json);
  else
    print_text(fmt::format(
        "{}: {} rays, {} hits, {:.2f} s to build, {:.2f} s to trace "
        "({:.2f} million/s), result {}\n",
        options.output, rays.size(), outcome.hits, accelerator->report().seconds,
        outcome.trace_seconds, json["mrays_per_second"].get<double>(), to_hex(outcome.hash)));
  return kExitOk;
}

void add_ray_options(CLI::App& command, QueryOptions& options) {
  command.add_option("--rays", options.rays, "(N,6) or (N,8) rays, f4 or f8")
      ->required()
      ->type_name("RAYS.npy");
  command.add_option("--mask", options.masks, "(N,) u4, one mask per ray")->type_name("M.npy");
  command.add_option("--exclude", options.excluded, "(N,3) u4: instance, geometry, primitive")
      ->type_name("IDS.npy");
  command
      .add_option("--after", options.after,
                  "(N,4) f8: t, instance, geometry, primitive; only later hits are seen")
      ->type_name("CURSOR.npy");
  command.add_flag("--cull", options.cull, "Only front sides are hit");
}

}  // namespace

void add_query_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("query", "Trace rays from a file");
  command->footer(
      "Queries: closest (the first hit), any (is there one), all (every hit in order), count (how\n"
      "many), inside (where the origins lie: -1 outside, 0 on the surface, 1 inside).\n"
      "Rays: ox oy oz dx dy dz [t_min t_max]; without the last two 0 and infinity.\n"
      "A ray sees geometry g of the file if bit g mod 32 of its mask is set.\n"
      "Output: NPZ with t_hit, primitive_ids, geometry_ids, instance_ids, face_ids,\n"
      "primitive_uvs, primitive_normals (all: also ray_ids, ray_splits), or occluded, counts,\n"
      "inside. It does not depend on structure and threads: equal result hashes, equal bits.\n"
      "Examples:\n"
      "  strahl query bunny.ply --rays rays.npy -o hits.npz\n"
      "  strahl query city.glb --rays rays.npy --query any --structure kd_tree --json");
  auto options = std::make_shared<QueryOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required()->type_name("SCENE");
  add_ray_options(*command, *options);
  command->add_option("--query", options->query, "What to ask (default: closest)")
      ->type_name("KIND");
  command->add_option("--structure", options->spec, kSpecHelp)->type_name("SPEC");
  command->add_option("-o,--output", options->output, "File of answers")->type_name("OUT.npz");
  command->add_flag("--count", options->count, "Count work (slower), see 'counters' of --json");
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_query(*options); }; });
}

}  // namespace strahl::cli
