#include <algorithm>
#include <apps/strahl/compare_page.h>
#include <fstream>
#include <iterator>

#include <fmt/core.h>

namespace strahl::cli {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>strahl: comparison</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<style>
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 1180px;
       padding: 0 1rem; color: #222; }
h1, h2, h3 { font-weight: 600; } h2 { margin-top: 2.5rem; border-top: 1px solid #ddd;
       padding-top: 1rem; }
table { border-collapse: collapse; font-size: 13px; }
.wide { overflow-x: auto; } code, nav { overflow-wrap: anywhere; }
th, td { padding: .2rem .55rem; text-align: right; border-bottom: 1px solid #eee; }
td { white-space: nowrap; } .pair { margin-top: 1rem; }
th:first-child, td:first-child { text-align: left; font-family: ui-monospace, monospace; }
.best { background: #d9f2d9; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(500px, 1fr)); gap: 1rem;
        align-items: start; }
.chart { width: 100%; border: 1px solid #eee; }
.maps { display: grid; grid-template-columns: repeat(auto-fill, minmax(200px, 1fr)); gap: .8rem; }
.maps figure { margin: 0; } .maps img { width: 100%; image-rendering: pixelated; display: block; }
summary { cursor: pointer; font-weight: 600; margin: .8rem 0; }
figcaption { font-size: 12px; overflow-wrap: anywhere; }
</style></head><body>
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}
std::string escaped(const Json& text) { return escaped(text.get<std::string>()); }

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t given = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < given ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= given ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

/// The file as an image of the page; nothing when there is no such file.
std::string image(const std::filesystem::path& path, const char* type, const char* kind,
                  const std::string& title) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return "";
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return fmt::format("<img class=\"{}\" alt=\"{}\" src=\"data:image/{};base64,{}\">\n", kind,
                     escaped(title), type, base64(bytes));
}

std::string cell(const std::string& text, bool is_best = false) {
  return fmt::format("<td{}>{}</td>", is_best ? " class=\"best\"" : "", text);
}
std::string number(double value) {
  return value >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string rank_table(const Json& workload) {
  std::string text = fmt::format(
      "<p>Over {} scenes. All alike: p = {:.2g} (Friedman). Mean ranks differ where they are "
      "{:.2f} "
      "apart (Nemenyi, 5 %).</p><div class=\"wide\"><table><tr><th>structure</th><th>mean rank</th>"
      "<th>time</th><th>95 % interval</th><th>worst to best</th><th>wins</th></tr>\n",
      workload["scenes"].dump(), workload["friedman"]["p_value"].get<double>(),
      workload["critical_difference"].get<double>());
  for (const Json& s : workload["structures"]) {
    const Json& time = s["time_to_first"];
    text += "<tr>" + cell(escaped(s["spec"])) +
            cell(fmt::format("{:.2f}", s["mean_rank"].get<double>())) +
            cell(number(time[0].get<double>())) +
            cell(number(time[1].get<double>()) + " to " + number(time[2].get<double>())) +
            cell(number(s["worst_to_best"].get<double>())) + cell(s["wins"].dump()) + "</tr>\n";
  }
  return text + "</table></div>\n";
}

double fastest(const Json& rows, std::size_t workload) {
  double best = 0.0;
  for (const Json& row : rows)
    best = std::max(best, row["workloads"][workload]["mrays"].get<double>());
  return best;
}

std::string head(const std::vector<std::string>& columns) {
  std::string text = "<div class=\"wide\"><table><tr>";
  for (const std::string& column : columns) text += "<th>" + column + "</th>";
  return text + "</tr>\n";
}

/// A number, or "-" for what there is not.
std::string number_cell(const Json& value) {
  return cell(value.is_null() ? "-" : number(value.get<double>()));
}

std::string structure_table(const Json& scene) {
  std::string text = head({"structure", "build s", "bytes per primitive", "N_IN", "N_V", "N_EV",
                           "N_OIV", "SAH", "EPO"});
  for (const Json& row : scene["structures"]) {
    text += "<tr>" + cell(escaped(row["spec"])) + number_cell(row["build"]["seconds"]) +
            number_cell(row["build"]["bytes_per_primitive"]);
    for (const char* name : {"N_IN", "N_V", "N_EV", "N_OIV", "SAH", "EPO"})
      text += number_cell(row["statistics"][name]);
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

std::string speed_table(const Json& scene) {
  std::vector<std::string> columns{"Mrays/s"};
  for (const Json& workload : scene["workloads"]) columns.push_back(escaped(workload["workload"]));
  std::string text = head(columns);
  const Json& rows = scene["structures"];
  for (const Json& row : rows) {
    text += "<tr>" + cell(escaped(row["spec"]));
    for (std::size_t w = 0; w < row["workloads"].size(); ++w) {
      const double mrays = row["workloads"][w]["mrays"].get<double>();
      text += cell(number(mrays), mrays == fastest(rows, w));
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

std::string work_table(const Json& scene, std::size_t w) {
  std::string text =
      head({escaped(scene["workloads"][w]["workload"]), "rays", "time", "95 % interval",
            "break-even", "N_TS", "N_ETS", "N_EETS", "N_IT", "N_BIT"});
  for (const Json& row : scene["structures"]) {
    const Json &at = row["workloads"][w], &time = at["time_to_first"];
    text += "<tr>" + cell(escaped(row["spec"])) + cell(at["rays"].dump()) + number_cell(time[0]) +
            cell(number(time[1].get<double>()) + " to " + number(time[2].get<double>())) +
            number_cell(at["break_even"]);
    for (const char* name : {"N_TS", "N_ETS", "N_EETS", "N_IT", "N_BIT"})
      text += number_cell(at["per_ray"][name]);
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

std::string folded(const std::string& title, const std::string& content) {
  if (content.empty()) return "";
  return "<details><summary>" + title + "</summary>\n" + content + "</details>\n";
}

std::string maps(const Json& scene, const std::filesystem::path& folder, const char* kind,
                 const std::string& title) {
  std::string pictures;
  for (const Json& row : scene["structures"]) {
    if (!row.contains("maps")) continue;
    const std::string picture = image(folder / row["maps"][kind].get<std::string>(), "png", "map",
                                      title + ": " + row["spec"].get<std::string>());
    pictures +=
        "<figure>" + picture + "<figcaption>" + escaped(row["spec"]) + "</figcaption></figure>\n";
  }
  if (pictures.empty()) return "";
  return "<div class=\"maps\">" + pictures + "</div>\n";
}

/// What the last colour of a kind of maps stands for.
std::string scale_text(const Json& scene, const char* kind) {
  if (!scene.contains("map_scales")) return "";
  return number(scene["map_scales"][kind].get<double>());
}

std::string map_section(const Json& scene, const std::filesystem::path& folder) {
  const auto of = [&](const char* kind, const std::string& title) {
    return maps(scene, folder, kind, title);
  };
  const std::string steps = of("steps", "Steps per ray"), tests = of("tests", "Tests per ray"),
                    difference = of("difference", "Difference of tests");
  if (steps.empty()) return "";
  return "<h4>Steps per ray: dark 0, bright " + scale_text(scene, "steps") + " and more</h4>" +
         steps +
         folded(
             "Primitive tests per ray: dark 0, bright " + scale_text(scene, "tests") + " and more",
             tests) +
         folded("Primitive tests against the first structure: blue fewer, red more, full colour " +
                    scale_text(scene, "difference"),
                difference);
}

/// A chart by its name, if it was drawn.
std::string chart_image(const std::vector<Chart>& charts, const std::string& name,
                        const std::filesystem::path& folder) {
  for (const Chart& chart : charts)
    if (chart.name == name)
      return image(folder / "charts" / (name + ".svg"), "svg+xml", "chart", chart.title);
  return "";
}

std::string workload_section(const Json& workload, const std::vector<Chart>& charts,
                             const std::filesystem::path& folder) {
  const std::string name = workload["workload"].get<std::string>();
  const auto chart = [&](const char* kind) { return chart_image(charts, kind + name, folder); };
  return "<h3>" + escaped(name) + "</h3><div class=\"pair\"><div>" + rank_table(workload) +
         "</div>" + chart("ranks_") + chart("size_") + chart("memory_") + "</div>\n";
}

std::string scene_section(const Json& document, std::size_t i, const std::vector<Chart>& charts,
                          const std::filesystem::path& folder) {
  const Json& scene = document["scenes"][i];
  std::string work;
  for (std::size_t w = 0; w < scene["workloads"].size(); ++w) work += work_table(scene, w);
  return fmt::format("<h2 id=\"scene{}\">{}</h2><p>{} primitives, scene hash {}</p>\n", i,
                     escaped(scene["scene"]), scene["primitives"].dump(),
                     escaped(scene["scene_hash"])) +
         structure_table(scene) + "<div class=\"pair\">" + speed_table(scene) +
         chart_image(charts, fmt::format("total_{}", i), folder) + "</div>\n" +
         folded("Work per ray, and time relative to the first structure", work) +
         map_section(scene, folder);
}

std::string options_text(const Json& options) {
  std::string text = "<p>";
  for (const auto& [name, value] : options.items()) {
    std::string list;
    for (const Json& item : value.is_array() ? value : Json::array({value}))
      list +=
          (list.empty() ? "" : ", ") + (item.is_string() ? item.get<std::string>() : item.dump());
    text += escaped(name) + ": <code>" + escaped(list) + "</code><br>\n";
  }
  return text + "</p>\n";
}

std::string links(const Json& scenes) {
  std::string text = "<nav>Scenes:";
  for (std::size_t i = 0; i < scenes.size(); ++i)
    text += fmt::format(" <a href=\"#scene{}\">{}</a>", i, escaped(scenes[i]["scene"]));
  return text + "</nav>\n";
}

}  // namespace

std::string compare_page(const Json& document, const std::vector<Chart>& charts,
                         const std::filesystem::path& folder) {
  std::string text = kHead;
  text +=
      "<h1>Structures compared</h1>\n<p>The same rays for every structure, runs interleaved, "
      "structures built anew for each repeat, every answer compared bit by bit. Times are relative "
      "to the first structure; those of ranks are geometric means over scenes with intervals over "
      "scenes, those of one scene medians with intervals over repeats.</p>\n";
  text += options_text(document["options"]) + links(document["scenes"]) + "<h2>Ranks</h2>\n";
  for (const Json& workload : document["summary"]["workloads"])
    text += workload_section(workload, charts, folder);
  for (std::size_t i = 0; i < document["scenes"].size(); ++i)
    text += scene_section(document, i, charts, folder);
  return text + "</body></html>\n";
}

}  // namespace strahl::cli
