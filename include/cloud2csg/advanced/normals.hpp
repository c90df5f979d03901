#pragma once

#include <cstddef>

#include "cloud2csg/advanced/scale.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Normals made from positions, and how sure their orientation is.
struct EstimatedNormals {
  Points normals;            ///< unit length, out of the solid
  std::size_t bodies = 0;    ///< parts that no neighbours join; 0 with sensors
  std::size_t doubtful = 0;  ///< points whose neighbours or winding number contradict their orientation
  Eigen::Vector3d doubtful_at = Eigen::Vector3d::Zero();  ///< one of them
};

/// Normals of robust local planes, which follow the faces at edges, oriented outward; towards its inside in a cavity.
/// Where the cloud has sensor positions, towards these; neighbours decide where the line of sight grazes the surface,
/// and where nearly all of them say otherwise.
/// Else small flat patches, within which the sides are sure, are turned such that the winding number, the mean of both
/// sides of the surface, is one half everywhere, and that neighbours across their borders agree (a normal is mirrored
/// from one point to the other, which holds around edges and across thin walls). Patches that votes of neighbours join
/// are tried as groups. So walls are told apart that are one to two spacings and about five times the noise thick;
/// where the winding number stays far from one half the result is doubtful, as on a surface that is open on one side,
/// where the larger part decides. O(n log n + p^2) for the p patches, some thousands at most
/// @throws Cancelled
[[nodiscard]] EstimatedNormals estimate_normals(const PointCloud& cloud, const Scale& scale,
                                                const RunContext& run = {});

enum class NormalsVerdict {
  outward,    ///< as they should be
  inward,     ///< right but for the sign of all
  unoriented  ///< not across the surface, or with signs that contradict each other: of no use
};

/// What the normals of a cloud are worth, told from a sample of its points; by its sensor positions, where it has them,
/// which way they lead. Precondition: the cloud has normals.
/// O(n log n) @throws Cancelled
[[nodiscard]] NormalsVerdict check_normals(const PointCloud& cloud, const Scale& scale, const RunContext& run = {});

}  // namespace cloud2csg
