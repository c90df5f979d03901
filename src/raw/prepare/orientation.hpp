#pragma once

#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"
#include "raw/prepare/local_fit.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// How well two normals agree across the step between their points: the first, mirrored at the plane halfway between
/// them, times the second. 1: certainly alike, -1: certainly one is wrong. Holds on planes and around convex, concave
/// and rounded edges, and for the two sides of a wall or gap. (König and Gumhold 2009 argue for such a rule.)
[[nodiscard]] double agreement(const Eigen::Vector3d& step, const Eigen::Vector3d& normal,
                               const Eigen::Vector3d& other_normal);

struct Orientation {
  std::vector<char> flipped;           ///< normals to turn
  std::vector<char> is_doubtful = {};  ///< the winding number contradicts; empty with sensors
  std::size_t bodies = 0;
};

/// Which normals to turn so that all lead out of the solid: small patches whose points agree for sure, each turned such
/// that the winding number is one half on all of the surface, and their borders agree. `places` are the points moved
/// onto their planes, `areas` the surface that each stands for.
/// @throws Cancelled
[[nodiscard]] Orientation find_orientation(const Points& places, const Points& normals,
                                           const NeighbourTable& neighbours, const std::vector<double>& areas,
                                           double noise, const RunContext& run, const StageShare& share);

/// Which normals to turn so that all look towards the sensors that saw their points. Where the line of sight grazes the
/// surface, an error of the normal would decide: there the neighbours have the say, those seen squarely the most. O(n)
/// @throws Cancelled
[[nodiscard]] std::vector<char> orient_to_sensors(const Points& places, const Points& normals, const Points& sensors,
                                                  const NeighbourTable& neighbours, const RunContext& run,
                                                  const StageShare& share);

/// The normals of planes that were fitted already, turned outward: the second half of estimate_normals().
/// @throws Cancelled
[[nodiscard]] EstimatedNormals orient_fits(const PointCloud& cloud, const LocalFits& fits, const Scale& scale,
                                           const RunContext& run, const StageShare& share);

}  // namespace cloud2csg
