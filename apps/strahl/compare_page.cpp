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
.wide { overflow-x: auto; }
th, td { padding: .25rem .6rem; text-align: right; border-bottom: 1px solid #eee; }
th:first-child, td:first-child { text-align: left; font-family: ui-monospace, monospace; }
.best { background: #e7f6e7; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(520px, 1fr)); gap: 1rem; }
.chart { width: 100%; border: 1px solid #eee; }
.maps { display: grid; grid-template-columns: repeat(auto-fill, minmax(200px, 1fr)); gap: .8rem; }
.maps figure { margin: 0; } .maps img { width: 100%; image-rendering: pixelated; display: block; }
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
      "<h3>{}</h3><p>Over {} scenes. All alike: p = {:.2g} (Friedman). Mean ranks differ where "
      "they are {:.2f} apart (Nemenyi, 5 %).</p><div class=\"wide\"><table><tr><th>structure</th>"
      "<th>mean rank</th><th>time</th><th>95 % interval</th><th>worst to best</th><th>wins</th>"
      "</tr>\n",
      escaped(workload["workload"]), workload["scenes"].dump(),
      workload["friedman"]["p_value"].get<double>(), workload["critical_difference"].get<double>());
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

std::string scene_table(const Json& scene) {
  const Json& rows = scene["structures"];
  std::string text =
      "<div class=\"wide\"><table><tr><th>structure</th><th>build s</th><th>B/prim."
      "</th><th>SAH</th><th>EPO</th>";
  for (const Json& workload : scene["workloads"]) {
    const std::string name = escaped(workload["workload"]);
    text += fmt::format("<th>{0}<br>Mrays/s</th><th>{0}<br>steps</th><th>{0}<br>tests</th>", name);
  }
  text += "</tr>\n";
  for (const Json& row : rows) {
    const Json& overlap = row["build"]["epo"];
    text += "<tr>" + cell(escaped(row["spec"])) +
            cell(number(row["build"]["seconds"].get<double>())) +
            cell(number(row["build"]["bytes_per_primitive"].get<double>())) +
            cell(number(row["build"]["sah_cost"].get<double>())) +
            cell(overlap.is_null() ? "-" : number(overlap.get<double>()));
    for (std::size_t w = 0; w < row["workloads"].size(); ++w) {
      const Json& at = row["workloads"][w];
      const double mrays = at["mrays"].get<double>();
      text += cell(number(mrays), mrays == fastest(rows, w)) +
              cell(number(at["per_ray"]["N_TS"].get<double>())) +
              cell(number(at["per_ray"]["N_IT"].get<double>()));
    }
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
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
  return "<h4>" + title + "</h4><div class=\"maps\">" + pictures + "</div>\n";
}

std::string scene_section(const Json& scene, const std::filesystem::path& folder) {
  return fmt::format("<h2>{}</h2><p>{} primitives, scene hash {}</p>\n", escaped(scene["scene"]),
                     scene["primitives"].dump(), escaped(scene["scene_hash"])) +
         scene_table(scene) +
         maps(scene, folder, "steps", "Steps per ray, one scale for all structures") +
         maps(scene, folder, "tests", "Primitive tests per ray, one scale for all structures") +
         maps(scene, folder, "difference",
              "Tests against the first structure: blue fewer, red more");
}

}  // namespace

std::string compare_page(const Json& document, const std::vector<Chart>& charts,
                         const std::filesystem::path& folder) {
  std::string text = kHead;
  text +=
      "<h1>Structures compared</h1>\n<p>The same rays for every structure, runs interleaved, "
      "every answer compared bit by bit. Times are relative to the first structure; "
      "intervals are over scenes.</p>\n<p>Options: <code>" +
      escaped(document["options"].dump()) + "</code></p>\n<h2>Ranks</h2>\n";
  for (const Json& workload : document["summary"]["workloads"]) text += rank_table(workload);
  text += "<h2>Charts</h2><div class=\"charts\">\n";
  for (const Chart& chart : charts)
    text += image(folder / "charts" / (chart.name + ".svg"), "svg+xml", "chart", chart.title);
  text += "</div>\n";
  for (const Json& scene : document["scenes"]) text += scene_section(scene, folder);
  return text + "</body></html>\n";
}

}  // namespace strahl::cli
