// apps/strahl/progress.h - the progress bar on stderr.
//
// Thread safety: one call at a time (BuildContext sees to that).
#pragma once

#include <string>
#include <string_view>

#include <strahl/base/timer.h>

namespace strahl::cli {

/// One line, redrawn in place: stage, bar, percent, remaining time. Draws nothing when disabled.
class ProgressBar {
 public:
  explicit ProgressBar(bool enabled) : enabled_(enabled) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// fraction in 0..1 of the stage; redraws ten times a second at most.
  void update(double fraction, std::string_view stage);
  /// Removes the line, so that other text can follow.
  void clear();

 private:
  void draw(double fraction);

  bool enabled_;
  bool visible_ = false;
  std::string stage_;
  Timer in_stage_, since_drawn_;
};

/// The line itself, without control characters: "tracing [#####.....]  50 %  eta 0:03".
std::string progress_line(double fraction, std::string_view stage, double seconds);

}  // namespace strahl::cli
