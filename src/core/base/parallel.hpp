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

/// The number of threads for a run, at most the machine's: TBB warns on standard error about more.
inline int usable_threads(const RunContext& run) {
  const int cores = oneapi::tbb::info::default_concurrency();
  return run.threads > 0 ? std::min(run.threads, cores) : cores;
}

#ifdef CLOUD2CSG_THREAD_SANITIZER
/// for_each_index() without TBB, for builds with the thread sanitizer. The sanitizer cannot see how a TBB built without
/// it synchronises: it would report every loop or, with these reports suppressed, miss races of our own. Iterations are
/// handed out in relaxed memory order, so that races between them show.
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

/// for_each_index() on the threads of the caller's arena, for nested loops.
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

/// Calls work(i) for i = 0 .. count - 1 on the threads of the run. Each call writes only data of its own i, so that the
/// result does not depend on the schedule. Passes on exceptions. @throws Cancelled
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

/// for_each_index() for short calls, `chunk` at a time. Reports progress as `share`, from one thread at a time.
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
