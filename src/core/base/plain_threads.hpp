#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cloud2csg {

/// The loop of for_each_index() without TBB, for builds with the thread sanitizer: it cannot see how a TBB that was not
/// built with it synchronises, and would either report every loop or, with those reports suppressed, see no race of
/// ours. Iterations are handed out without ordering one after the other, so that races between them show.
template <typename Work>
void run_on_plain_threads(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex failing;
  std::exception_ptr failure;
  const auto take_turns = [&] {
    try {
      for (;;) {
        const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
        if (i >= count) return;
        work(i);
      }
    } catch (...) {
      const std::lock_guard lock(failing);
      failure = std::current_exception();
      next.store(count, std::memory_order_relaxed);
    }
  };
  {
    std::vector<std::jthread> others;
    for (int t = 1; t < threads; ++t) others.emplace_back(take_turns);
    take_turns();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace cloud2csg
