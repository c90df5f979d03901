#include "pipeline/time_limit.hpp"

#include <algorithm>

namespace cloud2csg {

TimeLimit::TimeLimit(const std::stop_token& caller, std::optional<double> seconds)
    : on_caller_(caller, RequestStop{source_}) {
  if (!seconds) return;
  const std::chrono::duration<double> limit(*seconds);
  // The clock's counter holds ten years; longer limits mean no limit.
  if (limit > std::chrono::years(10)) return;
  end_ = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit);
  watch_ = std::jthread([this](const std::stop_token& done) {
    std::unique_lock lock(mutex_);
    timer_.wait_until(lock, done, *end_, [&done] { return done.stop_requested(); });
    if (!done.stop_requested()) source_.request_stop();
  });
}

void TimeLimit::enforce() const {
  if (end_ && std::chrono::steady_clock::now() >= *end_) source_.request_stop();
}

std::optional<double> seconds_left(std::optional<double> limit, const Stopwatch& watch) {
  if (limit) limit = std::max(k_next_to_nothing, *limit - watch.seconds());
  return limit;
}

}  // namespace cloud2csg
