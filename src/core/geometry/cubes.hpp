#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"

/// Places sorted into the cubes of a lattice.
namespace cloud2csg {

/// The key of the cube with this edge that contains a place. Precondition: no coordinate exceeds 2^20 edges
[[nodiscard]] std::uint64_t cube_of(const Eigen::Vector3d& place, double edge);

/// Connected groups of things, given the cubes that hold them: those in one cube or in touching cubes. Groups are
/// ascending indices, the largest group first. O(n log n)
[[nodiscard]] std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const std::uint64_t> cubes);

}  // namespace cloud2csg
