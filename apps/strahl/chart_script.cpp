#include <algorithm>
#include <apps/strahl/chart_script.h>
#include <spawn.h>
#include <sys/wait.h>

#include <fmt/core.h>

#include <strahl/base/error.h>
#include <strahl/io/atomic_file.h>

namespace strahl::cli {
namespace {

std::string color(std::size_t i) {
  static constexpr const char* kColors[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                            "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};
  return fmt::format("lc rgb '{}'", kColors[i % std::size(kColors)]);
}

/// Runs gnuplot on a script in the folder. Its exit status; -1 where it cannot be started.
int run_gnuplot(const std::filesystem::path& folder, const std::string& script) {
  const std::string place = folder.string();
  std::string name = "gnuplot", execute = "-e", change = "cd " + quoted(place);
  std::string file = script;
  char* arguments[] = {name.data(), execute.data(), change.data(), file.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "gnuplot", nullptr, nullptr, arguments, environ) != 0) return -1;
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string chart_head(const std::string& name, const std::string& title, const std::string& x,
                       const std::string& y) {
  return fmt::format(
      "set terminal svg size 760,460 dynamic background rgb 'white' font 'Helvetica,13'\n"
      "set output '{}.svg'\nset termoption noenhanced\nset title {}\nset xlabel {}\n"
      "set ylabel {}\nset grid lc rgb '#dddddd'\nset key outside right top\n",
      name, quoted(title), quoted(x), quoted(y));
}

std::string line_style(std::size_t i) {
  return color(i) + fmt::format(" lw 1.6 dt {}", 1 + i / 10);
}
std::string point_style(std::size_t i) {
  return color(i) + fmt::format(" pt {} ps 0.8", 4 + i % 11);
}

std::string data_block(std::size_t i, const Points& points) {
  std::string text = fmt::format("$d{} << EOD\n", i);
  for (const auto& [x, y] : points) text += fmt::format("{:.6g} {:.6g}\n", x, y);
  return text + "EOD\n";
}

std::string log_range(const char* axis, const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return fmt::format("set {}range [{:.6g}:{:.6g}]\n", axis, *least / 2, *most * 2);
}

bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  bool has_gnuplot = true;
  for (const Chart& chart : charts) {
    write_text_file(folder / (chart.name + ".gp"), chart.script);
    const int status = has_gnuplot ? run_gnuplot(folder, chart.name + ".gp") : -1;
    has_gnuplot = status != -1 && status != 127;
    if (has_gnuplot && status != 0)
      throw Error(ErrorCode::resource, fmt::format("gnuplot failed with status {}", status),
                  (folder / (chart.name + ".gp")).string());
  }
  return has_gnuplot;
}

}  // namespace strahl::cli
