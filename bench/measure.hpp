#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/run.hpp"

namespace cloud2csg::bench {

/// The shipped model "m0", "m1", "m2" or "m3".
inline Model shipped_model(const std::string& name) {
  return read_model(std::string(CLOUD2CSG_DATA_DIR "/models/") + name + ".json");
}

/// A cloud like the paper's: noise of sigma 0.01 on a model of about unit size.
inline PointCloud paper_cloud(const Model& model, std::size_t points, std::uint64_t seed) {
  RunContext all_cores;
  all_cores.threads = 0;
  return sample_surface(model, {.count = points, .noise = 0.01, .seed = seed}, all_cores);
}

/// Seconds of several equal runs. On a shared machine the median is quoted; the least shows the machine's limit.
struct Timing {
  double least = 0, median = 0, most = 0;
};

template <class Work>
Timing time_runs(std::size_t runs, const Work& work) {
  std::vector<double> seconds;
  for (std::size_t run = 0; run < runs; ++run) {
    const Stopwatch watch;
    work();
    seconds.push_back(watch.seconds());
  }
  std::ranges::sort(seconds);
  return {seconds.front(), seconds[seconds.size() / 2], seconds.back()};
}

}  // namespace cloud2csg::bench
