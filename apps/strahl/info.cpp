// apps/strahl/info.cpp - `strahl info`: what a scene holds, and what a structure makes of it.
#include <apps/strahl/commands.h>
#include <memory>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/catalog/catalog.h>

namespace strahl::cli {
namespace {

struct InfoOptions : CommonOptions {
  std::string scene, spec;
  bool epo = false;
};

Json scene_json(const Scene& scene) {
  const SceneCounts& counts = scene.counts();
  return {{"scene", scene.data().source},
          {"triangles", counts.triangles},
          {"spheres", counts.spheres},
          {"cones", counts.cones},
          {"geometries", scene.geometries().size()},
          {"instances", scene.instances().size()},
          {"materials", scene.data().materials.size()},
          {"instanced_primitives", counts.references},
          {"refused",
           {{"total", counts.refused()},
            {"zero_area", counts.refused_zero_area},
            {"not_finite", counts.refused_not_finite},
            {"repeated_vertex", counts.refused_repeated_vertex},
            {"curved", counts.refused_curved}}},
          {"bounds", to_json(scene.total_bounds())},
          {"has_view", scene.data().view.has_value()},
          {"lights", scene.data().lights.size()},
          {"warnings", scene.data().warnings},
          {"scene_hash", to_hex(scene.hash())}};
}

/// What the structure will take, null where it cannot tell.
Json estimate_json(const Scene& scene, const std::string& spec, const BuildContext& context) {
  const auto bytes = estimate_bytes(scene, spec, context);
  return {{"spec", spec}, {"bytes", bytes ? Json(*bytes) : Json(nullptr)}};
}

Json structure_json(const Accelerator& accelerator, bool epo, const BuildContext& context) {
  Json json = to_json(accelerator.report());
  if (epo) json["epo"] = to_json(accelerator.end_point_overlap(context));
  const std::uint32_t primitives = accelerator.scene().size();
  const auto bytes = static_cast<double>(accelerator.report().bytes);
  json["bytes_per_primitive"] = primitives > 0 ? Json(bytes / primitives) : Json(nullptr);
  json["valid"] = true;
  json["tree_hash"] = to_hex(accelerator.tree_hash());
  Json result = {{"spec", accelerator.spec()}};
  result.update(json);
  return result;
}

/// A JSON value as a table cell.
std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_null()) return "-";
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& item : value) text += (text.empty() ? "" : " ") + cell(item);
  return text.empty() ? "-" : text;
}

/// Rows "name value", one per leaf of the document.
std::string table(const Json& json, const std::string& prefix = {}) {
  std::string text;
  for (const auto& [key, value] : json.items()) {
    const std::string name = prefix + key;
    text += value.is_object() ? table(value, name + ".")
                              : fmt::format("{:<30} {}\n", name, cell(value));
  }
  return text;
}

int run_info(const InfoOptions& options) {
  Session session(options);
  const std::shared_ptr<const Scene> scene = session.load(options.scene);
  Json json = scene_json(*scene);
  const std::string spec = options.spec.empty() ? std::string(kDefaultSpec)
                                                : session.chosen_spec(scene, options.spec, {});
  json["estimate"] = estimate_json(*scene, spec, session.context());
  if (!options.spec.empty()) {
    const std::unique_ptr<Accelerator> accelerator = session.build(scene, spec);
    accelerator->validate();
    json["structure"] = structure_json(*accelerator, options.epo, session.context());
    session.finish_progress();
  }
  options.json ? print_json(json) : print_text(table(json));
  return kExitOk;
}

}  // namespace

void add_info_command(CLI::App& app, Runner& run) {
  CLI::App* command =
      app.add_subcommand("info", "Statistics of a scene, and of a structure built over it");
  command->footer(
      "Prints also what the structure will take in memory, if it can tell before it is built.\n"
      "With --structure the structure is built, its invariants are checked (exit code 1 if one is\n"
      "broken) and its size is reported. --epo adds the end-point overlap of a tree of bounding\n"
      "volumes or of two levels of such: what rays cost in nodes that hold their end but not the\n"
      "primitive they end on, in node steps. It takes longer than the build. '-' for other\n"
      "structures.\n"
      "Examples:\n"
      "  strahl info bunny.ply\n"
      "  strahl info gen:gears:4 --structure kd_tree --json\n"
      "  strahl info bunny.ply --structure bvh:builder=ploc --epo");
  auto options = std::make_shared<InfoOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required()->type_name("SCENE");
  CLI::Option* structure =
      command->add_option("--structure", options->spec, "Build this, see 'strahl list'")
          ->type_name("SPEC");
  command->add_flag("--epo", options->epo, "Also its end-point overlap")->needs(structure);
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_info(*options); }; });
}

}  // namespace strahl::cli
