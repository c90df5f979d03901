#include "progress_display.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <utility>

#include "core/base/text.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::chrono::milliseconds k_redraw_interval{50};
constexpr std::size_t k_bar_width = 30;
constexpr std::string_view k_clear_line = "\r\x1b[K";
/// What is left of a stage is not told before it has run so long: the first steps say little of the others.
constexpr double k_seconds_before_forecast = 1;

/// "4.1 M": three digits at most, and a letter for thousands.
std::string short_number(double value) {
  constexpr std::array<std::string_view, 4> k_thousands{"", " k", " M", " G"};
  std::size_t power = 0;
  // 999.5 would be rounded to 1000.
  while (value >= 999.5 && power + 1 < k_thousands.size()) value /= 1000, ++power;
  return fmt::format("{:.{}f}{}", value, value < 9.95 ? 1 : 0, k_thousands[power]);
}

/// Empty for what says nothing: one of something, or no time.
std::string rate_text(std::size_t count, std::string_view unit, double seconds) {
  if (unit.empty() || count < 2 || seconds <= 0) return {};
  return fmt::format("{} {}/s", short_number(static_cast<double>(count) / seconds), unit);
}

std::string time_text(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

/// By what was done in `seconds`.
std::string forecast(const Progress& progress, double seconds) {
  if (progress.done == 0 || progress.done >= progress.total || seconds < k_seconds_before_forecast) return {};
  const auto left = static_cast<double>(progress.total - progress.done);
  return time_text(seconds * left / static_cast<double>(progress.done)) + " left";
}

double seconds_between(ProgressClock::time_point start, ProgressClock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

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

ProgressDisplay::ProgressDisplay(std::FILE* out, ProgressStyle style, std::function<ProgressClock::time_point()> now)
    : out_(out), style_(style), now_(std::move(now)), stage_start_(now_()) {}

ProgressDisplay::~ProgressDisplay() {
  if (std::uncaught_exceptions() == 0) {
    finish();
  } else if (has_bar() && !stage_.empty()) {
    put(std::string(k_clear_line));
  }
}

void ProgressDisplay::put(const std::string& text) const {
  std::fputs(text.c_str(), out_);
}

void ProgressDisplay::update(const Progress& progress) {
  const bool is_done = progress.total > 0 && progress.done >= progress.total;
  if (style_ == ProgressStyle::none || (is_done && stage_.empty() && progress.stage == ended_)) return;
  if (progress.stage != stage_) {
    finish();
    stage_ = progress.stage;
  }
  if (!progress.unit.empty()) {
    unit_ = progress.unit;
    count_ = std::max(progress.done, progress.total);
  }
  if (is_done) {
    finish();
  } else if (has_bar()) {
    const ProgressClock::time_point now = now_();
    if (now - last_drawn_ >= k_redraw_interval) draw(progress, now);
  }
}

std::string ProgressDisplay::bar(const Progress& progress, double seconds) const {
  const double share = std::min(1.0, static_cast<double>(progress.done) / static_cast<double>(progress.total));
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(k_bar_width));
  std::string done = std::string(filled, '#');
  if (style_ == ProgressStyle::color_bar) done = "\x1b[32m" + done + "\x1b[0m";
  std::string text = fmt::format("[{}{}] {:3.0f} %", done, std::string(k_bar_width - filled, '.'), 100 * share);
  for (const std::string& part : {rate_text(progress.done, progress.unit, seconds), forecast(progress, seconds)}) {
    if (!part.empty()) text += "  " + part;
  }
  return text;
}

void ProgressDisplay::draw(const Progress& progress, ProgressClock::time_point now) {
  last_drawn_ = now;
  const double seconds = seconds_between(stage_start_, now);
  std::string line = fmt::format("{}{:<12} ", k_clear_line, stage_);
  if (progress.total > 0) {
    line += bar(progress, seconds);
  } else if (progress.done > 0) {
    line += fmt::format("{} {}  {}", progress.done, progress.unit, rate_text(progress.done, progress.unit, seconds));
  }
  put(line);
  std::fflush(out_);
}

void ProgressDisplay::note(std::string_view line) {
  if (style_ == ProgressStyle::none) return;
  finish();
  put(visible_text(line) + "\n");
}

void ProgressDisplay::finish() {
  if (stage_.empty()) return;
  const ProgressClock::time_point now = now_();
  const double seconds = seconds_between(stage_start_, now);
  std::string line = fmt::format("{}{:<12} {:.3f} s", has_bar() ? k_clear_line : "", stage_, seconds);
  if (!unit_.empty() && count_ > 1) {
    const std::string rate = rate_text(count_, unit_, seconds);
    line += fmt::format("  {} {}{}{}", count_, unit_, rate.empty() ? "" : ", ", rate);
  }
  put(line + "\n");
  std::fflush(out_);
  stage_start_ = now;
  last_drawn_ = {};
  unit_.clear();
  count_ = 0;
  ended_ = std::exchange(stage_, {});
}

}  // namespace cloud2csg::app
