#pragma once

#include <cstddef>

/// What solids cost a person who edits them, in leaves: see price_of().
namespace cloud2csg {

/// For the segments of a profile. A whole circle is one.
[[nodiscard]] double price_of_segments(std::size_t segments);

/// For the planes of a polytope.
[[nodiscard]] double price_of_planes(std::size_t planes);

/// What one segment costs beyond the fourth: as much as gives a gear of a hundred segments the price of ten boxes.
inline constexpr double k_segment_price = 0.1;

}  // namespace cloud2csg
