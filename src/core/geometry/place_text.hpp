#pragma once

#include <string>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// A place as a person reads it, "(1.25, -0.5, 3)": to a ten-thousandth of the diagonal of what it is in, however far
/// that is from the origin.
[[nodiscard]] std::string place_text(const Eigen::Vector3d& place, double diagonal);

/// Where points are most crowded: the mean of those in the fullest of the cubes of a lattice. Of several as full ones,
/// always the same. O(n). Precondition: there are points, and the width is positive.
[[nodiscard]] Eigen::Vector3d crowded_place(const Points& points, double width);

}  // namespace cloud2csg
