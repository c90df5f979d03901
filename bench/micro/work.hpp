#pragma once

#include <functional>
#include <string>
#include <vector>

#include "micro/machine.hpp"

namespace cloud2csg::bench {

/// Of the clouds that are measured on.
constexpr std::size_t k_points = 150'000;

/// What has to be done for one unit of a benchmark, however it is programmed. What is left out makes the bound lower,
/// never wrong.
struct Work {
  std::string unit;              ///< what "one" is: "point x primitive"
  double units = 1;              ///< that a run of the benchmark does
  double single_operations = 0;  ///< of a unit, and so are all below: single precision, additions and the like
  double divisions = 0;
  double roots = 0;
  double byte_extrema = 0;
  double look_ups = 0;  ///< in a table of look_up_rows x look_up_row numbers
  std::size_t look_up_rows = 0, look_up_row = 0;
  double bytes_read = 0, bytes_written = 0;
  std::size_t footprint = 0;  ///< bytes that are gone through again and again: says which memory they are in
};

struct Bound {
  double seconds;  ///< of a unit
  std::string by;  ///< what takes longest
};

/// The units of a processor work side by side, so the slowest alone is the bound, not the sum.
[[nodiscard]] Bound bound_of(const Work& work, const ArithmeticRates& rates);

struct Microbenchmark {
  std::string name;
  Work work;
  std::function<void()> run;
};

/// The benchmarks, a file each.
[[nodiscard]] std::vector<Microbenchmark> pass_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> evaluation_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> search_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> clique_benchmarks();
[[nodiscard]] std::vector<Microbenchmark> tree_benchmarks();

}  // namespace cloud2csg::bench
