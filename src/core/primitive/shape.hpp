#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// One function object from several lambdas, for std::visit.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// Whether a revolution has no caps: it turns by 360 degrees.
[[nodiscard]] bool is_full_turn(const Revolution& revolution);

/// In radians.
[[nodiscard]] double turn_of(const Revolution& revolution);

/// Sizes, radii and heights in the order of the struct. Empty for shapes without a fixed number of lengths.
[[nodiscard]] std::vector<double> lengths_of(const Shape& shape);

/// The shape with all lengths times the factor. Half-spaces and expressions stay. Precondition: factor > 0.
[[nodiscard]] Shape scaled(Shape shape, double factor);

}  // namespace cloud2csg
