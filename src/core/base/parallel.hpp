#pragma once

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>

#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"

#if defined(__SANITIZE_THREAD__)
#define CLOUD2CSG_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define CLOUD2CSG_THREAD_SANITIZER
#endif
#endif
#ifdef CLOUD2CSG_THREAD_SANITIZER
#include <exception>
#include <thread>
#include <vector>
#endif

namespace cloud2csg {

/// The threads that a run asks for, no more than the machine has: TBB would warn about more on the standard error.
inline int usable_threads(const RunContext& run) {
  const int cores = oneapi::tbb::info::default_concurrency();
  return run.threads > 0 ? std::min(run.threads, cores) : cores;
}

#ifdef CLOUD2CSG_THREAD_SANITIZER
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
#endif

/// Calls work(i) for i = 0 .. count - 1 on the threads of the arena that the caller is in, for loops within loops. The
/// same rules as for for_each_index().
template <typename Work>
void for_each_index_in_arena(std::size_t count, const RunContext& run, const Work& work) {
  if (run.threads == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
#ifdef CLOUD2CSG_THREAD_SANITIZER
  run_on_plain_threads(count, usable_threads(run), work);
#else
  oneapi::tbb::parallel_for(std::size_t{0}, count, work);
#endif
}

/// Calls work(i) for i = 0 .. count - 1 on the threads of the run. Each call must write only what belongs to its i, so
/// that the result does not depend on the schedule. An exception of a call is passed on.
/// @throws Cancelled
template <typename Work>
void for_each_index(std::size_t count, const RunContext& run, const Work& work) {
  const auto one = [&](std::size_t i) {
    run.throw_if_stopped();
    work(i);
  };
  if (run.threads == 1) {
    for_each_index_in_arena(count, run, one);
    return;
  }
  oneapi::tbb::task_arena arena(usable_threads(run));
  arena.execute([&] { for_each_index_in_arena(count, run, one); });
}

/// The same for calls that are so short that handing them out one by one would take longer: `chunk` of them at a time.
/// Reports how far it is as `share` of a stage, from one thread at a time.
template <typename Work>
void for_each_index_by_chunks(std::size_t count, std::size_t chunk, const RunContext& run, const StageShare& share,
                              const Work& work) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::atomic<std::size_t> done = 0;
  std::mutex telling;
  for_each_index(chunks, run, [&](std::size_t c) {
    const std::size_t end = std::min(count, (c + 1) * chunk);
    for (std::size_t i = c * chunk; i < end; ++i) work(i);
    ++done;
    const std::unique_lock lock(telling, std::try_to_lock);
    if (lock) share.report(run, static_cast<double>(done) / static_cast<double>(chunks));
  });
}

template <typename Work>
void for_each_index_by_chunks(std::size_t count, std::size_t chunk, const RunContext& run, const Work& work) {
  for_each_index_by_chunks(count, chunk, run, StageShare(), work);
}

}  // namespace cloud2csg
