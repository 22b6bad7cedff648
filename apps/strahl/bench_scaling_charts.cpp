#include <apps/strahl/bench_scaling.h>
#include <functional>

#include <fmt/core.h>

namespace strahl::cli {
namespace {

struct Series {
  std::string label;
  Points points;
};

/// One line per engine and, where there are several, way of handing over.
using SeriesList = std::vector<Series>;

Points& points_of(SeriesList& list, const std::string& label) {
  for (Series& series : list)
    if (series.label == label) return series.points;
  list.push_back({label, {}});
  return list.back().points;
}

Chart chart_of(const std::string& name, const std::string& title, const std::string& y,
               const SeriesList& list) {
  std::string script = chart_head(name, title, "triangles", y) +
                       "set logscale x\nset format x '10^%T'\nset termoption enhanced\n"
                       "set yrange [0:*]\n";
  std::string plot = "plot ";
  for (std::size_t i = 0; i < list.size(); ++i) {
    script += data_block(i, list[i].points);
    plot +=
        fmt::format("{}$d{} using 1:2 with linespoints {} pt {} ps 0.7 title {} noenhanced",
                    i > 0 ? ", " : "", i, line_style(i), 5 + 2 * (i % 5), quoted(list[i].label));
  }
  return {name, title, script + plot + "\n"};
}

Chart row_chart(const Json& rows, const char* name, const char* title, const char* y,
                const std::function<double(const Json&)>& value) {
  SeriesList list;
  for (const Json& row : rows)
    points_of(list, row["engine"].get<std::string>())
        .emplace_back(row["triangles"].get<double>(), value(row));
  return chart_of(name, title, y, list);
}

Chart time_chart(const Json& rows, const std::string& workload) {
  SeriesList list;
  for (const Json& row : rows)
    for (const Json& ray : row["rays"])
      if (ray["workload"] == workload)
        points_of(list, row["engine"].get<std::string>() + " " + ray["api"].get<std::string>())
            .emplace_back(row["triangles"].get<double>(), ray["nanoseconds_per_ray"].get<double>());
  return chart_of("time_" + workload, "Time per ray: " + workload, "nanoseconds per ray", list);
}

}  // namespace

std::vector<Chart> scaling_charts(const Json& rows) {
  std::vector<Chart> charts;
  if (rows.empty()) return charts;
  for (const Json& ray : rows[0]["rays"])
    if (ray["api"] == "batch") charts.push_back(time_chart(rows, ray["workload"]));
  charts.push_back(
      row_chart(rows, "build", "Build", "nanoseconds per triangle", [](const Json& row) {
        return 1e9 * row["build_seconds"].get<double>() / row["triangles"].get<double>();
      }));
  charts.push_back(row_chart(rows, "memory", "Memory", "bytes per triangle", [](const Json& row) {
    return row["bytes_per_triangle"].get<double>();
  }));
  return charts;
}

}  // namespace strahl::cli
