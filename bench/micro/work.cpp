#include "micro/work.hpp"

#include <algorithm>
#include <array>

namespace cloud2csg::bench {

Bound bound_of(const Work& work, const ArithmeticRates& rates) {
  const std::array<Bound, 6> each{{
      {work.single_operations / rates.single, "arithmetic"},
      {work.divisions / rates.single_division + work.roots / rates.single_root, "divisions"},
      {work.byte_extrema / rates.byte_extremum, "min/max"},
      {work.look_ups > 0 ? work.look_ups / measure_gathering(work.look_up_rows, work.look_up_row) : 0, "look-ups"},
      {work.bytes_read > 0 ? work.bytes_read / measure_reading(work.footprint) : 0, "reading"},
      {work.bytes_written > 0 ? work.bytes_written / measure_writing(work.footprint) : 0, "writing"},
  }};
  return *std::ranges::max_element(each, {}, &Bound::seconds);
}

}  // namespace cloud2csg::bench
