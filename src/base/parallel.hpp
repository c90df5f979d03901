#pragma once

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// The threads that a run asks for, no more than the machine has: TBB would warn about more on the standard error.
inline int usable_threads(const RunContext& run) {
  const int cores = oneapi::tbb::info::default_concurrency();
  return run.threads > 0 ? std::min(run.threads, cores) : cores;
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
    for (std::size_t i = 0; i < count; ++i) one(i);
    return;
  }
  oneapi::tbb::task_arena arena(usable_threads(run));
  arena.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, count, one); });
}

}  // namespace cloud2csg
