#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// @throws Error (where = "planes" or "planes/3") when a plane is not finite, a normal is not of unit length, or the
/// planes' half-spaces have no bounded intersection with volume. O(planes^4).
void validate_polytope(const Polytope& polytope);

/// The polytope with every plane moved outward: where the largest distance from a plane is below `distance`.
[[nodiscard]] Polytope grown(const Polytope& polytope, double distance);

/// The surface of a polytope, in its own frame.
struct PolytopeFaces {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::vector<std::size_t>> faces;  ///< corner numbers counter-clockwise seen from outside
};

/// Planes that only touch the solid have no face. A plane that is given twice has one face.
[[nodiscard]] PolytopeFaces faces_of(const Polytope& polytope);

}  // namespace cloud2csg
