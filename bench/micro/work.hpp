#pragma once

#include <functional>
#include <string>
#include <vector>

#include "micro/machine.hpp"

namespace cloud2csg::bench {

/// Points of the benchmark's clouds.
constexpr std::size_t k_points = 150'000;

/// Necessary work per unit of a benchmark, for any implementation. Omitted work makes the bound lower, never wrong.
struct Work {
  std::string unit;              ///< the unit's name: "point x primitive"
  double units = 1;              ///< units per run of the benchmark
  double single_operations = 0;  ///< per unit, like all counts below: single-precision additions and the like
  double divisions = 0;
  double roots = 0;
  double byte_extrema = 0;
  double look_ups = 0;  ///< in a table of look_up_rows x look_up_row numbers
  std::size_t look_up_rows = 0, look_up_row = 0;
  double bytes_read = 0, bytes_written = 0;
  std::size_t footprint = 0;  ///< bytes in repeated use, which determine the cache level
};

struct Bound {
  double seconds;  ///< per unit
  std::string by;  ///< the resource that takes longest
};

/// The processor's units work in parallel, so the slowest one gives the bound.
[[nodiscard]] Bound bound_of(const Work& work, const ArithmeticRates& rates);

struct Microbenchmark {
  std::string name;
  Work work;
  std::function<void()> run;
};

[[nodiscard]] std::vector<Microbenchmark> pass_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> evaluation_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> search_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> clique_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> tree_benchmarks();

}  // namespace cloud2csg::bench
