#pragma once

#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg::app {

enum class ProgressStyle {
  none,   ///< says nothing
  lines,  ///< one line a stage, when it has ended: for logs
  bar,    ///< the running stage as a bar that is drawn over, on a terminal
  color_bar,
};

/// `bar` only when the file is a terminal that can move its cursor; with colour unless NO_COLOR is set (no-color.org).
[[nodiscard]] ProgressStyle progress_style(std::FILE* out, bool quiet);

/// Shows how far the stages are. A stage ends when all of it is done, when the next one starts, or with finish(); its
/// time is counted from the end of the one before.
class ProgressDisplay {
 public:
  ProgressDisplay(std::FILE* out, ProgressStyle style) : out_(out), style_(style) {}
  /// Ends the running stage; one that was left by an exception has not ended and gets no line.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ProgressDisplay(ProgressDisplay&&) = delete;
  ProgressDisplay& operator=(ProgressDisplay&&) = delete;

  void update(const Progress& progress);
  /// Ends the running stage and prints a line of its own.
  void note(std::string_view line);
  /// Ends the running stage.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool has_bar() const { return style_ == ProgressStyle::bar || style_ == ProgressStyle::color_bar; }
  void draw(const Progress& progress);

  std::FILE* out_;
  ProgressStyle style_;
  std::string stage_;  ///< the running one; empty for none
  std::string ended_;  ///< the last one that ended
  Clock::time_point stage_start_ = Clock::now();
  Clock::time_point last_drawn_;
};

}  // namespace cloud2csg::app
