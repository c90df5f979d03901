#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Whether one smooth surface through two places, a step apart, may have these normals, up to their signs: they are
/// alike, and the step lies in the surface as far as the angle between them tells. The other side of a wall does not.
[[nodiscard]] bool on_one_surface(const Eigen::Vector3d& step, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& other, double noise);

/// The surface that each point stands for. Neighbours count as far as they are not on the other side of a wall or gap:
/// those would make thin walls too light. O(n width)
[[nodiscard]] std::vector<double> surface_areas(const Points& places, const Points& normals,
                                                const NeighbourTable& neighbours, double noise);

/// Small pieces of a surface, each nearly flat: within one the normals agree for sure, as each of its points is held
/// against its first point, not against the one that led to it.
struct Patches {
  static constexpr std::uint32_t k_none = UINT32_MAX;
  std::vector<std::uint32_t> of_point;             ///< the patch of each point, k_none where it is in none
  std::vector<char> flipped;                       ///< of each point: its normal is opposite to those of its patch
  std::vector<std::vector<std::uint32_t>> points;  ///< of each patch
};

/// Grows patches of at most `most` points along neighbours; those of fewer than `least` points are left out. Two
/// points are on one piece of surface when their normals, up to the sign, are alike, and the step between them lies in
/// the surface as far as the angle between the normals tells: the other side of a wall does not. O(n width)
[[nodiscard]] Patches grow_patches(const Points& places, const Points& normals, const NeighbourTable& neighbours,
                                   double noise, std::size_t least, std::size_t most);

}  // namespace cloud2csg
