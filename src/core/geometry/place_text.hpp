#pragma once

#include <string>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// A place as text, "(1.25, -0.5, 3)", to a ten-thousandth of the diagonal of the object around it, wherever that is.
[[nodiscard]] std::string place_text(const Eigen::Vector3d& place, double diagonal);

/// The mean of the points in the fullest cube of a lattice. Deterministic. O(n). Precondition: points, and width > 0.
[[nodiscard]] Eigen::Vector3d crowded_place(const Points& points, double width);

}  // namespace cloud2csg
