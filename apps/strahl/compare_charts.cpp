#include <algorithm>
#include <apps/strahl/compare_charts.h>
#include <cmath>
#include <functional>

#include <fmt/core.h>

namespace strahl::cli {
namespace {

std::string text_of(const Json& json) { return json.get<std::string>(); }

/// The SPEC of structure i, short enough to leave room for the chart.
std::string label(const Json& row, std::size_t i) {
  constexpr std::size_t kLongest = 26;
  const std::string spec = text_of(row["spec"]);
  if (spec.size() <= kLongest) return quoted(spec);
  return quoted(fmt::format("{}.. [{}]", spec.substr(0, kLongest - 6), i + 1));
}

enum class Marks { lines, points };

/// "plot" of data blocks $d0, $d1, ... titled by structure.
std::string plot_blocks(const Json& rows, Marks marks) {
  std::string text = "plot ";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string with =
        marks == Marks::lines ? "lines " + line_style(i) : "points " + point_style(i);
    text += fmt::format("{}$d{} using 1:2 with {} title {}", i > 0 ? ", " : "", i, with,
                        label(rows[i], i));
  }
  return text + "\n";
}

/// Scenes are no series: points, the more of a structure in a line the better it scales.
Chart size_chart(const Json& scenes, std::size_t w, const std::string& workload) {
  const std::string name = "size_" + workload, title = "Time per ray over scene size: " + workload;
  const Json& rows = scenes[0]["structures"];
  std::vector<double> sizes, times;
  std::string blocks;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Points points;
    for (const Json& scene : scenes) {
      sizes.push_back(std::max(scene["primitives"].get<double>(), 1.0));
      times.push_back(1e3 / scene["structures"][i]["workloads"][w]["mrays"].get<double>());
      points.emplace_back(sizes.back(), times.back());
    }
    std::sort(points.begin(), points.end());
    blocks += data_block(i, points);
  }
  return {name, title,
          chart_head(name, title, "primitives", "nanoseconds per ray") + log_range("x", sizes) +
              log_range("y", times) + "set logscale xy\nset format xy '%.0s%c'\n" + blocks +
              plot_blocks(rows, Marks::points)};
}

/// Bars of mean ranks; those whose whisker, half the critical difference to each side, overlap
/// cannot be told apart.
Chart rank_chart(const Json& summary) {
  const std::string workload = text_of(summary["workload"]);
  const std::string name = "ranks_" + workload, title = "Mean rank (1 is fastest): " + workload;
  const Json& structures = summary["structures"];
  const double half = summary["critical_difference"].get<double>() / 2;
  std::string ticks, data = "$d << EOD\n";
  for (std::size_t i = 0; i < structures.size(); ++i) {
    const double rank = structures[i]["mean_rank"].get<double>();
    ticks += fmt::format("{}{} {}", i > 0 ? ", " : "", label(structures[i], i), i);
    data += fmt::format("{:.6g} {} {:.6g} {:.6g}\n", rank, i, rank - half, rank + half);
  }
  return {name, title,
          chart_head(name, title, "mean rank, with half the critical difference (5 %) to each side",
                     "") +
              fmt::format("set ytics ({})\nset yrange [{}.5:-0.5]\nset key off\n", ticks,
                          structures.size() - 1) +
              data +
              "EOD\nplot $d using 1:2:3:4 with xerrorbars lc rgb '#1f77b4' pt 7 lw 1.6 ps 0.9\n"};
}

double geometric_mean_over(const Json& scenes, const std::function<double(const Json&)>& value) {
  double sum = 0.0;
  for (const Json& scene : scenes) sum += std::log(std::max(value(scene), 1e-12));
  return std::exp(sum / static_cast<double>(scenes.size()));
}

Chart memory_chart(const Json& scenes, std::size_t w, const std::string& workload) {
  const std::string name = "memory_" + workload, title = "Memory against speed: " + workload;
  std::string script = chart_head(name, title, "bytes per primitive (geometric mean over scenes)",
                                  "million rays per second (geometric mean)") +
                       "set logscale xy\n";
  const Json& rows = scenes[0]["structures"];
  std::vector<double> all_bytes, all_speeds;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double bytes = geometric_mean_over(scenes, [&](const Json& scene) {
      return scene["structures"][i]["build"]["bytes_per_primitive"].get<double>();
    });
    const double speed = geometric_mean_over(scenes, [&](const Json& scene) {
      return scene["structures"][i]["workloads"][w]["mrays"].get<double>();
    });
    all_bytes.push_back(std::max(bytes, 0.1)), all_speeds.push_back(speed);
    script += data_block(i, {{all_bytes.back(), speed}});
  }
  script += log_range("x", all_bytes) + log_range("y", all_speeds);
  return {name, title, script + plot_blocks(rows, Marks::points)};
}

/// Where two lines cross, the dearer build has paid.
Chart total_chart(const Json& scene, std::size_t number) {
  const std::string name = fmt::format("total_{}", number),
                    title = "Build and rays together: " + text_of(scene["scene"]);
  std::string script = chart_head(name, title, "rays of all workloads alike", "seconds") +
                       "set logscale xy\nset format x '1e%T'\n";
  const Json& rows = scene["structures"];
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double per_ray = 0.0;
    for (const Json& cell : rows[i]["workloads"])
      per_ray +=
          1e-6 / cell["mrays"].get<double>() / static_cast<double>(rows[i]["workloads"].size());
    Points points;
    for (double rays = 1e3; rays < 2e9; rays *= std::sqrt(10.0))
      points.emplace_back(rays, rows[i]["build"]["seconds"].get<double>() + rays * per_ray);
    script += data_block(i, points);
  }
  script += plot_blocks(rows, Marks::lines);
  return {name, title, script};
}

}  // namespace

std::vector<Chart> compare_charts(const Json& document) {
  const Json& scenes = document["scenes"];
  std::vector<Chart> charts;
  if (scenes.empty()) return charts;
  const Json& workloads = document["summary"]["workloads"];
  for (std::size_t w = 0; w < workloads.size(); ++w) {
    const std::string workload = text_of(workloads[w]["workload"]);
    charts.push_back(size_chart(scenes, w, workload));
    charts.push_back(rank_chart(workloads[w]));
    charts.push_back(memory_chart(scenes, w, workload));
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) charts.push_back(total_chart(scenes[i], i));
  return charts;
}

}  // namespace strahl::cli
