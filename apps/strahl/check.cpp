// apps/strahl/check.cpp - `strahl check`: the mesh doctor.
#include <apps/strahl/commands.h>
#include <memory>

#include <fmt/core.h>

#include <strahl/geometry/mesh_check.h>

namespace strahl::cli {
namespace {

struct CheckOptions : CommonOptions {
  std::string scene;
  std::size_t keep = 10;
};

Json finding_json(const MeshFinding& finding) {
  return {{"defect", name_of(finding.defect)}, {"count", finding.count}, {"first", finding.first}};
}

const char* kind_name(PrimitiveKind kind) {
  return kind == PrimitiveKind::triangle ? "triangle"
         : kind == PrimitiveKind::sphere ? "sphere"
                                         : "cone";
}

/// The report of all geometries; total counts the findings.
Json check_json(const SceneData& data, std::size_t keep, std::uint64_t& total) {
  Json geometries = Json::array();
  for (std::size_t g = 0; g < data.geometries.size(); ++g) {
    const Geometry& geometry = data.geometries[g];
    Json findings = Json::array();
    for (const MeshFinding& finding : check_mesh(geometry, keep)) {
      findings.push_back(finding_json(finding));
      total += finding.count;
    }
    geometries.push_back({{"geometry_id", geometry.geometry_id},
                          {"name", geometry.name},
                          {"kind", kind_name(geometry.kind)},
                          {"primitives", geometry.size()},
                          {"findings", findings}});
  }
  return geometries;
}

std::string check_text(const Json& geometries, std::uint64_t total) {
  std::string text;
  for (const Json& geometry : geometries) {
    for (const Json& finding : geometry["findings"]) {
      std::string first;
      for (const Json& id : finding["first"]) first += fmt::format(" {}", id.get<std::uint64_t>());
      const bool is_all = finding["first"].size() == finding["count"].get<std::uint64_t>();
      text += fmt::format(
          "geometry {:<6} {:<22} {:>10}  {}s{}{}\n", geometry["geometry_id"].get<std::uint32_t>(),
          finding["defect"].get<std::string>(), finding["count"].get<std::uint64_t>(),
          geometry["kind"].get<std::string>(), first, is_all ? "" : " ...");
    }
  }
  return text + (total == 0 ? "no findings\n" : fmt::format("{} findings\n", total));
}

int run_check(const CheckOptions& options) {
  Session session(options);
  const SceneData data = session.load_data(options.scene);
  std::uint64_t total = 0;
  const Json geometries = check_json(data, options.keep, total);
  if (options.json)
    print_json({{"scene", options.scene},
                {"ok", total == 0},
                {"findings", total},
                {"geometries", geometries}});
  else
    print_text(check_text(geometries, total));
  return total == 0 ? kExitOk : kExitCheckFailed;
}

}  // namespace

void add_check_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("check", "Mesh doctor: what is wrong with a scene");
  command->footer(
      "Finds triangles of zero area, with repeated or non-finite vertices, out of range,\n"
      "duplicates; edges of one triangle (open), of three or more (non-manifold), of two that\n"
      "wind against each other; spheres and cones that cannot be hit. Vertices at the same\n"
      "position count as one. Exit code 1 if there is any finding.\n"
      "Examples:\n"
      "  strahl check part.stl\n"
      "  strahl check part.stl --json --first 100");
  auto options = std::make_shared<CheckOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required()->type_name("SCENE");
  command->add_option("--first", options->keep, "Cases listed per finding (default: 10)")
      ->type_name("N");
  add_output_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_check(*options); }; });
}

}  // namespace strahl::cli
