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

/// The lengths that make a solid of a kind, in the order of its struct: sizes, radii, heights. None for the kinds that
/// are not made by a fixed number of lengths.
[[nodiscard]] std::vector<double> lengths_of(const Shape& shape);

}  // namespace cloud2csg
