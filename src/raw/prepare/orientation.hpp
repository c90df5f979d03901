#pragma once

#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"
#include "raw/prepare/local_fit.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Agreement of two normals across the step between their points: one normal reflected at the plane halfway between
/// them, times the other. 1: certainly consistent, -1: certainly one is wrong. Valid on planes, around convex, concave
/// and rounded edges, and for the two sides of a wall or gap. (König and Gumhold 2009 argue for such a rule.)
[[nodiscard]] double agreement(const Eigen::Vector3d& step, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& other_normal);

struct Orientation {
  std::vector<char> flipped;           ///< normals to flip
  std::vector<char> is_doubtful = {};  ///< whether the winding number contradicts; empty with sensors
  std::size_t bodies = 0;
};

/// Finds the normals to flip so that all point out of the solid. Flips small patches, whose normals agree with
/// certainty, until the winding number is one half on the whole surface and their borders agree. `places` are the
/// points projected onto their planes, `areas` their shares of the surface. @throws Cancelled
[[nodiscard]] Orientation find_orientation(const Points& places, const Points& normals,
                                           const NeighbourTable& neighbours, const std::vector<double>& areas,
                                           double noise, const RunContext& run, const StageShare& share);

/// Finds the normals to flip so that all face the sensors of their points. At grazing lines of sight, where an error of
/// the normal would decide, the neighbours vote, with more weight if seen squarely. O(n) @throws Cancelled
[[nodiscard]] std::vector<char> orient_to_sensors(const Points& places, const Points& normals, const Points& sensors,
                                                  const NeighbourTable& neighbours, const RunContext& run,
                                                  const StageShare& share);

/// Orients the normals of fitted planes outward: the second half of estimate_normals(). @throws Cancelled
[[nodiscard]] EstimatedNormals orient_fits(const PointCloud& cloud, const LocalFits& fits, const Scale& scale,
                                           const RunContext& run, const StageShare& share);

}  // namespace cloud2csg
