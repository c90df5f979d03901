#include "session.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <system_error>
#include <utility>

#include "core/base/files.hpp"
#include "core/base/text.hpp"

namespace cloud2csg::app {
namespace {

constexpr int k_status_interrupted = 130;  // 128 + SIGINT, as shells count
constexpr std::array k_signals{SIGINT, SIGTERM, SIGHUP};
constexpr char k_byte_interrupt = 'i';
constexpr char k_byte_quit = 'q';

// Global, since a signal handler has no argument.
std::atomic<int> pipe_write_end = -1;   // NOLINT(readability-identifier-naming)
std::atomic<bool> is_stopping = false;  // NOLINT(readability-identifier-naming)
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "only lock-free atomics may be used in a signal handler");

/// Async-signal-safe: the watcher thread calls std::stop_source::request_stop(), which may take locks.
extern "C" void on_interrupt(int /*signal*/) {
  if (is_stopping.exchange(true)) {
    remove_temporaries();
    ::_exit(k_status_interrupted);
  }
  const int saved = errno;
  [[maybe_unused]] const ssize_t written = ::write(pipe_write_end.load(), &k_byte_interrupt, 1);
  errno = saved;
}

constexpr std::chrono::milliseconds k_redraw_interval{50};
constexpr std::size_t k_bar_width = 30;
constexpr std::string_view k_clear_line = "\r\x1b[K";
/// A forecast from the first steps would be unreliable.
constexpr double k_seconds_before_forecast = 1;

/// "4.1 M": at most three digits and a letter for thousands.
std::string short_number(double value) {
  constexpr std::array<std::string_view, 4> k_thousands{"", " k", " M", " G"};
  std::size_t power = 0;
  // 999.5 would round to 1000.
  while (value >= 999.5 && power + 1 < k_thousands.size()) value /= 1000, ++power;
  return fmt::format("{:.{}f}{}", value, value < 9.95 ? 1 : 0, k_thousands[power]);
}

/// Empty where a rate means nothing: a count of one, or no time.
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

/// Extrapolates from the steps done in `seconds`.
std::string forecast(const Progress& progress, double seconds) {
  if (progress.done == 0 || progress.done >= progress.total || seconds < k_seconds_before_forecast) return {};
  const auto left = static_cast<double>(progress.total - progress.done);
  return time_text(seconds * left / static_cast<double>(progress.done)) + " left";
}

double seconds_between(ProgressClock::time_point start, ProgressClock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace

InterruptWatcher::InterruptWatcher() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  pipe_read_ = ends[0];
  pipe_write_end = ends[1];
  is_stopping = false;
  watcher_ = std::thread([this] {
    char byte = k_byte_quit;
    while (::read(pipe_read_, &byte, 1) < 0 && errno == EINTR) {
    }
    if (byte == k_byte_interrupt) stop_.request_stop();
  });
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t k = 0; k < old_.size(); ++k) ::sigaction(k_signals[k], &action, &old_[k]);
}

InterruptWatcher::~InterruptWatcher() {
  for (std::size_t k = 0; k < old_.size(); ++k) ::sigaction(k_signals[k], &old_[k], nullptr);
  const int write_end = pipe_write_end.exchange(-1);
  [[maybe_unused]] const ssize_t written = ::write(write_end, &k_byte_quit, 1);
  watcher_.join();
  ::close(write_end);
  ::close(pipe_read_);
}

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
  if (style_ != ProgressStyle::none) say(line);
}

void ProgressDisplay::say(std::string_view line) {
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

Session::Session(const RunOptions& options, std::stop_token stop)
    : display_(stderr, progress_style(stderr, options.quiet)),
      run_{.stop = std::move(stop),
           .on_progress = [this](const Progress& progress) { display_.update(progress); },
           .threads = options.threads} {}

void Session::warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) display_.say("warning: " + warning);
}

}  // namespace cloud2csg::app
