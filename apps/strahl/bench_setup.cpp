#include <apps/strahl/bench_setup.h>

#include <fmt/core.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/render/framing.h>

namespace strahl::cli {

std::vector<WorkloadKind> BenchOptions::workload_kinds() const {
  const std::string list = !workloads.empty() ? workloads
                           : with_scaling     ? "primary,random"
                                              : "primary,diffuse,shadow,ao,random";
  std::vector<WorkloadKind> kinds;
  for (const std::string& name : split_specs(list)) kinds.push_back(workload_kind(name));
  return kinds;
}

const char* name_of(OwnApi api) { return api == OwnApi::single ? "single" : "batch"; }

std::string spec_for(OwnApi api, const std::string& spec) {
  const std::string name = spec.substr(0, spec.find(':'));
  if (api == OwnApi::batch || name != "wide_bvh" || spec.find("batch=") != std::string::npos)
    return spec;
  return spec + (name.size() == spec.size() ? ":" : ",") + "batch=single";
}

WorkloadOptions rays_of(const BenchOptions& options, const Scene& scene) {
  const auto side = static_cast<std::size_t>(options.size);
  return {default_view(scene, options.size, options.size), side * side, options.seed};
}

std::unique_ptr<peer::Peer> peer_over(const Scene& scene, const BenchOptions& options,
                                      const Session& session, peer::PeerQuality quality) {
  if (!options.has_peer()) return nullptr;
  return peer::make_peer(scene, {quality, options.isa, session.context().executor});
}

std::string label_of(const std::string& scene) {
  return scene.starts_with("gen:") ? scene : scene.substr(scene.rfind('/') + 1);
}

void add_estimate(Json& json, const std::string& name, const std::optional<Estimate>& estimate) {
  json[name] = estimate ? Json(estimate->value) : Json(nullptr);
  json[name + "_low"] = estimate ? Json(estimate->low) : Json(nullptr);
  json[name + "_high"] = estimate ? Json(estimate->high) : Json(nullptr);
}

std::optional<Estimate> mean_of(const std::vector<const Json*>& rows, const std::string& name) {
  const auto mean = [&](const std::string& key) {
    std::vector<double> values;
    for (const Json* row : rows)
      if (!(*row)[key].is_null()) values.push_back((*row)[key].get<double>());
    return values.empty() ? std::optional<double>() : geometric_mean(values).value;
  };
  const std::optional<double> value = mean(name);
  if (!value) return std::nullopt;
  return Estimate{*value, *mean(name + "_low"), *mean(name + "_high")};
}

std::string number_text(const Json& value, int digits) {
  return value.is_null() ? "-" : fmt::format("{:.{}f}", value.get<double>(), digits);
}

std::string estimate_text(const Json& row, const std::string& name) {
  if (row[name].is_null()) return "-";
  return fmt::format("{:.3f} ({:.3f} to {:.3f})", row[name].get<double>(),
                     row[name + "_low"].get<double>(), row[name + "_high"].get<double>());
}

}  // namespace strahl::cli
