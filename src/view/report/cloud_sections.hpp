#pragma once

#include "view/report/deviation.hpp"
#include "view/report/payload.hpp"

namespace cloud2csg {

/// The points to show, in the order of the deviation, thinned evenly to at most `most`. Each has its position in 16-bit
/// steps, its normal in two bytes (octahedral), its distance as a 16-bit float in units of the largest, and its owner
/// plus one (0: no owner, or an index beyond 16 bits).
[[nodiscard]] Payload::Json cloud_sections(const PointCloud& cloud, const Deviation& deviation, std::size_t most,
                                           Payload& payload);

/// A direction in two bytes: the octahedron |x| + |y| + |z| = 1 unfolded to a square. Error at most one degree.
struct OctahedralNormal {
  std::uint8_t u, v;
};
[[nodiscard]] OctahedralNormal octahedral(const Eigen::Vector3d& direction);

}  // namespace cloud2csg
