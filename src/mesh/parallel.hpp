#pragma once

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Calls body(i) for every i below count, on run.threads threads, in any order. @throws Cancelled
template <typename Body>
void for_each_index(std::size_t count, const RunContext& run, const Body& body) {
  // TBB prints a warning when asked for more threads than the machine has.
  const int available = tbb::info::default_concurrency();
  tbb::task_arena arena(run.threads > 0 ? std::min(run.threads, available) : available);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      run.throw_if_stopped();
      body(i);
    });
  });
}

}  // namespace cloud2csg
