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

/// Sizes, radii and heights in the order of the struct. Empty for shapes without a fixed number of lengths.
[[nodiscard]] std::vector<double> lengths_of(const Shape& shape);

/// The shape with all lengths times the factor. Half-spaces and expressions stay. Precondition: factor > 0.
[[nodiscard]] Shape scaled(Shape shape, double factor);

}  // namespace cloud2csg
