#pragma once

#include <cstddef>

/// What this machine can do at best on one core, measured by small loops that do nothing else, in the widest
/// instruction set that the library's kernels use here. Each is the best of several tries, so that bounds made of them
/// are not too high because something else ran.
namespace cloud2csg::bench {

/// Elements a second.
struct ArithmeticRates {
  double single;  ///< additions, multiplications, comparisons... of single-precision numbers, in vectors
  double fused;   ///< fused multiply-adds of the same; not used by the library, which wants the same bits everywhere
  double single_division;  ///< ... with its own, much slower unit
  double single_root;      ///< square roots, by the same unit
  double byte_extremum;    ///< minima and maxima of bytes
};
[[nodiscard]] ArithmeticRates measure_arithmetic();

/// Bytes a second, over and over through so many bytes: those of the level of the memory that they stay in.
[[nodiscard]] double measure_reading(std::size_t footprint);
[[nodiscard]] double measure_writing(std::size_t footprint);

/// Look-ups a second: one number at a random place in each of `rows` rows of `row` numbers, one row after the other.
[[nodiscard]] double measure_gathering(std::size_t rows, std::size_t row);

/// Name of the instruction set.
[[nodiscard]] const char* instruction_set();

}  // namespace cloud2csg::bench
