#pragma once

#include <cstddef>

/// Peak rates of this machine on one core, measured by small loops in the widest instruction set of the library's
/// kernels. Each is the best of several tries, so that other programs do not inflate the time bounds made of them.
namespace cloud2csg::bench {

/// Elements per second.
struct ArithmeticRates {
  double single;           ///< vector additions, multiplications, comparisons... in single precision
  double fused;            ///< fused multiply-adds; the library does not use them, to get the same bits everywhere
  double single_division;  ///< divisions, in their own, much slower unit
  double single_root;      ///< square roots, in the same unit
  double byte_extremum;
};
[[nodiscard]] ArithmeticRates measure_arithmetic();

/// Bytes per second of repeated passes over `footprint` bytes, which selects the cache level.
[[nodiscard]] double measure_reading(std::size_t footprint);
[[nodiscard]] double measure_writing(std::size_t footprint);

/// Look-ups per second: one number at a random place in each of `rows` rows of `row` numbers, row by row.
[[nodiscard]] double measure_gathering(std::size_t rows, std::size_t row);

[[nodiscard]] const char* instruction_set();

}  // namespace cloud2csg::bench
