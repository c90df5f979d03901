#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// The surface of a polytope, in its own frame.
struct PolytopeFaces {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::vector<std::size_t>> faces;  ///< corner numbers counter-clockwise seen from outside
};

/// Planes that only touch the solid have no face; of those that are given twice, one has.
[[nodiscard]] PolytopeFaces faces_of(const Polytope& polytope);

}  // namespace cloud2csg
