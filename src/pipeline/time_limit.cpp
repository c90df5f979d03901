#include "pipeline/time_limit.hpp"

#include <chrono>

namespace cloud2csg {

TimeLimit::TimeLimit(const std::stop_token& caller, std::optional<double> seconds)
    : on_caller_(caller, RequestStop{source_}) {
  if (!seconds) return;
  watch_ = std::jthread([this, limit = std::chrono::duration<double>(*seconds)](const std::stop_token& done) {
    std::unique_lock lock(mutex_);
    timer_.wait_for(lock, done, limit, [&done] { return done.stop_requested(); });
    if (!done.stop_requested()) source_.request_stop();
  });
}

}  // namespace cloud2csg
