#include <algorithm>
#include <apps/strahl/progress.h>
#include <cstdio>

#include <fmt/core.h>

namespace strahl::cli {
namespace {

constexpr int kWidth = 30;
constexpr double kRedrawSeconds = 0.1;
/// A stage shorter than this shows no bar: it would only flicker.
constexpr double kQuietSeconds = 0.3;

}  // namespace

std::string progress_line(double fraction, std::string_view stage, double seconds) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kWidth);
  std::string line = fmt::format("{:<10} [{:#<{}}{:.<{}}] {:3.0f} %", stage, "", filled, "",
                                 kWidth - filled, 100.0 * fraction);
  if (fraction > 0.0 && fraction < 1.0) {
    const auto left = static_cast<long>(std::min(seconds / fraction * (1.0 - fraction), 3.6e8));
    line += fmt::format("  eta {}:{:02}", left / 60, left % 60);
  }
  return line;
}

void ProgressBar::update(double fraction, std::string_view stage) {
  if (!enabled_) return;
  if (stage_ != stage) {
    stage_ = stage;
    in_stage_.restart();
  }
  if (in_stage_.seconds() < kQuietSeconds || since_drawn_.seconds() < kRedrawSeconds) return;
  draw(fraction);
}

void ProgressBar::draw(double fraction) {
  fmt::print(stderr, "\r\x1b[K{}", progress_line(fraction, stage_, in_stage_.seconds()));
  std::fflush(stderr);
  since_drawn_.restart();
  visible_ = true;
}

void ProgressBar::clear() {
  if (!visible_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  visible_ = false;
}

}  // namespace strahl::cli
