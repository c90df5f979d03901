#include "progress_display.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <utility>

namespace cloud2csg::app {
namespace {

constexpr std::chrono::milliseconds k_redraw_interval{50};
constexpr std::size_t k_bar_width = 30;
constexpr std::string_view k_clear_line = "\r\x1b[K";

}  // namespace

ProgressStyle progress_style(std::FILE* out, bool quiet) {
  if (quiet) return ProgressStyle::none;
  const char* terminal = std::getenv("TERM");
  if (::isatty(::fileno(out)) == 0 || terminal == nullptr || std::string_view(terminal) == "dumb") {
    return ProgressStyle::lines;
  }
  const char* no_color = std::getenv("NO_COLOR");
  return no_color != nullptr && *no_color != '\0' ? ProgressStyle::bar : ProgressStyle::color_bar;
}

ProgressDisplay::~ProgressDisplay() {
  if (std::uncaught_exceptions() == 0) {
    finish();
  } else if (has_bar() && !stage_.empty()) {
    fmt::print(out_, "{}", k_clear_line);
  }
}

void ProgressDisplay::update(const Progress& progress) {
  const bool is_done = progress.total > 0 && progress.done >= progress.total;
  if (style_ == ProgressStyle::none || (is_done && stage_.empty() && progress.stage == ended_)) return;
  if (progress.stage != stage_) {
    finish();
    stage_ = progress.stage;
  }
  if (is_done) {
    finish();
  } else if (has_bar() && Clock::now() - last_drawn_ >= k_redraw_interval) {
    draw(progress);
  }
}

void ProgressDisplay::draw(const Progress& progress) {
  last_drawn_ = Clock::now();
  std::string line = fmt::format("{}{:<12} ", k_clear_line, stage_);
  if (progress.total > 0) {
    const double share = std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(progress.total));
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(k_bar_width));
    std::string bar = std::string(filled, '#');
    if (style_ == ProgressStyle::color_bar) bar = "\x1b[32m" + bar + "\x1b[0m";
    line += fmt::format("[{}{}] {:3.0f} %", bar, std::string(k_bar_width - filled, '.'), 100 * share);
  } else if (progress.done > 0) {
    line += fmt::format("{}", progress.done);
  }
  fmt::print(out_, "{}", line);
  std::fflush(out_);
}

void ProgressDisplay::note(std::string_view line) {
  if (style_ == ProgressStyle::none) return;
  finish();
  fmt::print(out_, "{}\n", line);
}

void ProgressDisplay::finish() {
  if (stage_.empty()) return;
  const Clock::time_point now = Clock::now();
  const std::chrono::duration<double> seconds = now - stage_start_;
  fmt::print(out_, "{}{:<12} {:.3f} s\n", has_bar() ? k_clear_line : "", stage_, seconds.count());
  std::fflush(out_);
  stage_start_ = now;
  last_drawn_ = {};
  ended_ = std::exchange(stage_, {});
}

}  // namespace cloud2csg::app
