#include <apps/strahl/bench_race.h>
#include <apps/strahl/bench_worst.h>
#include <apps/strahl/text_table.h>
#include <cmath>
#include <limits>
#include <map>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>

namespace strahl::cli {
namespace {

using peer::FloatRay;

/// Somewhere inside the triangle, not at its rim.
Vec3d inner_point(const TriangleVertices& t, Rng& rng) {
  const double u = rng.uniform(0.1, 0.8), v = rng.uniform(0.1, 0.9 - u);
  return t.a + u * (t.b - t.a) + v * (t.c - t.a);
}

FloatRay ray_to(const Vec3d& org, const Vec3d& target) {
  return {Vec3f(org), 0.0f, Vec3f(target - org), std::numeric_limits<float>::infinity()};
}

/// Pairs from anywhere within twice the box; those that would be rounded are left out.
AimedRays candidates(const FlatMesh& mesh, const Aabb& box, double step, std::size_t count,
                     Rng& rng) {
  AimedRays rays;
  const Vec3d size = box.extent();
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleVertices t = mesh[rng.below(static_cast<std::uint32_t>(mesh.size()))];
    Vec3d org = box.center();
    for (int axis = 0; axis < 3; ++axis) org[axis] += size[axis] * rng.uniform(-1.0, 1.0);
    org = snapped(org, step);
    const FloatRay to_vertex = ray_to(org, t.a);
    if (Vec3d(to_vertex.dir) != t.a - org || to_vertex.dir == Vec3f{}) continue;
    rays.to_vertices.rays.push_back(to_vertex);
    rays.to_insides.rays.push_back(ray_to(org, inner_point(t, rng)));
  }
  return rays;
}

/// Vertices on the grid, whatever is not finite as it was.
FlatMesh snapped_mesh(FlatMesh mesh, double step) {
  for (Vec3d& v : mesh.vertices) v = snapped(v, step);
  return mesh;
}

/// Runs of two contestants in turn; the ratio is first over second.
template <class First, class Second>
Json ratio_json(const char* first_name, const Contest& first_contest, First first,
                const char* second_name, const Contest& second_contest, Second second, int repeat) {
  std::vector<double> a, b;
  for (int round = 0; round <= repeat; ++round) {
    const double first_seconds = first(), second_seconds = second();
    if (round == 0) continue;  // warms up
    a.push_back(first_seconds), b.push_back(second_seconds);
  }
  Json json = {{first_name, first_contest.mrays(a)}, {second_name, second_contest.mrays(b)}};
  add_estimate(json, "ratio", median_ratio(a, b));
  return json;
}

Json row_head(const std::string& name, const Scene& scene, const Entrant& entrant) {
  return {{"scene", label_of(name)},
          {"primitives", scene.size()},
          {"spec", entrant.spec},
          {"api", name_of(entrant.api)}};
}

std::string means_text(const Json& means) {
  std::vector<std::vector<std::string>> rows{{"geometric mean", "api", "time ratio (95 %)"}};
  for (const Json& row : means)
    rows.push_back({row["spec"].get<std::string>(), row["api"].get<std::string>(),
                    estimate_text(row, "ratio")});
  return text_table(rows);
}

/// @param what third column: a key of the rows
std::string ratio_markdown(const Json& rows, const char* what, const char* ordinary,
                           const char* special, const std::string& gate) {
  std::vector<std::vector<std::string>> table{{"scene", "primitives", what, "structure", "api",
                                               ordinary, special,
                                               "time ratio (95 %), at most " + gate}};
  for (const Json& row : rows)
    table.push_back({row["scene"].get<std::string>(), row["primitives"].dump(),
                     row[what].get<std::string>(), row["spec"].get<std::string>(),
                     row["api"].get<std::string>(), number_text(row[ordinary], 2),
                     number_text(row[special], 2), estimate_text(row, "ratio")});
  return text_table(table) + "\n" + means_text(means_of_apis(rows));
}

}  // namespace

AimedRays make_aimed_rays(const Accelerator& accelerator, const FlatMesh& mesh, double step,
                          std::size_t count, std::uint64_t seed) {
  constexpr int kMaxRounds = 16;
  Rng rng(seed);
  AimedRays kept;
  for (int round = 0; round < kMaxRounds && kept.to_vertices.rays.size() < count; ++round) {
    const AimedRays tried = candidates(mesh, accelerator.scene().total_bounds(), step, count, rng);
    std::vector<Hit> hits(tried.to_vertices.rays.size());
    accelerator.closest_hit(peer::batch_of(tried.to_vertices.rays), hits);
    for (std::size_t i = 0; i < hits.size() && kept.to_vertices.rays.size() < count; ++i) {
      if (std::abs(hits[i].t - 1.0) > 1e-9) continue;
      kept.to_vertices.rays.push_back(tried.to_vertices.rays[i]);
      kept.to_insides.rays.push_back(tried.to_insides.rays[i]);
    }
  }
  return kept;
}

void measure_worst(const std::string& name, const BenchOptions& options, Session& session,
                   Json& document) {
  const std::shared_ptr<const Scene> given = session.load(name);
  if (given->counts().triangles == 0) return session.warn(name + ": no triangles");
  const double step = coarse_step(given->total_bounds());
  const FlatMesh mesh = snapped_mesh(flat_mesh(*given), step);
  const std::shared_ptr<const Scene> scene = float_scene(mesh);
  const std::vector<Entrant> entrants = build_entrants(scene, split_specs(options.specs), session);
  AimedRays rays = make_aimed_rays(*entrants.front().accelerator, mesh, step,
                                   rays_of(options, *scene).rays, options.seed);
  if (rays.to_vertices.rays.empty()) return session.warn(name + ": no vertex to be seen");
  for (const bool is_any : {false, true}) {
    rays.to_vertices.is_any = rays.to_insides.is_any = is_any;
    Contest at_vertices(rays.to_vertices), inside(rays.to_insides);
    for (const Entrant& entrant : entrants) {
      Json row = row_head(name, *scene, entrant);
      row["query"] = is_any ? "any" : "closest";
      row["rays"] = rays.to_vertices.rays.size();
      row.update(ratio_json(
          "vertex_mrays", at_vertices, [&] { return at_vertices.run(*entrant.accelerator); },
          "inside_mrays", inside, [&] { return inside.run(*entrant.accelerator); },
          options.repeat));
      document["worst"].push_back(row);
    }
  }
}

void measure_doubles(const std::string& name, const BenchOptions& options, Session& session,
                     Json& document) {
  const std::shared_ptr<const Scene> given = session.load(name);
  if (given->counts().triangles == 0) return session.warn(name + ": no triangles");
  const FlatMesh mesh = flat_mesh(*given);
  const std::shared_ptr<const Scene> floats = float_scene(mesh),
                                     doubles = double_scene(mesh, given->total_bounds());
  const std::vector<std::string> specs = split_specs(options.specs);
  const std::vector<Entrant> of_floats = build_entrants(floats, specs, session),
                             of_doubles = build_entrants(doubles, specs, session);
  const std::vector<RaySet> sets =
      make_ray_sets(*of_floats.front().accelerator, options.workload_kinds(),
                    rays_of(options, *given), session.context());
  for (const RaySet& set : sets) {
    Contest contest(set);
    for (std::size_t i = 0; i < of_floats.size(); ++i) {
      Json row = row_head(name, *floats, of_floats[i]);
      row["workload"] = name_of(set.kind);
      row["rays"] = set.rays.size();
      row.update(ratio_json(
          "double_mrays", contest, [&] { return contest.run(*of_doubles[i].accelerator); },
          "float_mrays", contest, [&] { return contest.run(*of_floats[i].accelerator); },
          options.repeat));
      document["doubles"].push_back(row);
    }
  }
}

Json means_of_apis(const Json& rows) {
  std::map<std::pair<std::string, std::string>, std::vector<const Json*>> groups;
  for (const Json& row : rows) groups[{row["spec"], row["api"]}].push_back(&row);
  Json means = Json::array();
  for (const auto& [group, members] : groups) {
    Json mean = {{"spec", group.first}, {"api", group.second}, {"rows", members.size()}};
    add_estimate(mean, "ratio", mean_of(members, "ratio"));
    means.push_back(mean);
  }
  return means;
}

std::string worst_markdown(const Json& document) {
  return ratio_markdown(document["worst"], "query", "inside_mrays", "vertex_mrays", "3");
}

std::string doubles_markdown(const Json& document) {
  return ratio_markdown(document["doubles"], "workload", "float_mrays", "double_mrays", "1.35");
}

}  // namespace strahl::cli
