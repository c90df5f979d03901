#pragma once

#include <string>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// A place as text, "(1.25, -0.5, 3)", to a ten-thousandth of the diagonal of the object around it, wherever that is.
[[nodiscard]] std::string place_text(const Eigen::Vector3d& place, double diagonal);

}  // namespace cloud2csg
