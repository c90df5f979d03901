#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cloud2csg {

/// Places that repeat, in a plane: rows and grids of equal steps, and full circles of equal angles.
enum class Arrangement : std::uint8_t { none, grid, circle };

struct RegularPlaces {
  std::vector<Eigen::Vector2d> places;    ///< as many as there were; those of no arrangement are as given
  std::vector<Arrangement> arrangements;  ///< of each
};

/// Puts places into exact arrangements where that moves none by more than `tolerance`, those of most places first.
/// Places of one arrangement are of one kind. Three or more are a row, four or more a grid; steps are equal, orthogonal
/// and along the axes of the plane where that is within the tolerance as well. Three or more are a circle about their
/// own centre or about any of `centres`, on which it is laid. `weights`: how much a place counts in what is shared.
/// Of more than 1000 places of a kind, none is looked for. O(n^2 log n) for n of a kind.
/// Precondition: `kinds` and `weights` are as long as `places`; tolerance > 0.
[[nodiscard]] RegularPlaces regular_places(std::span<const Eigen::Vector2d> places, std::span<const int> kinds,
                                           std::span<const double> weights, std::span<const Eigen::Vector2d> centres,
                                           double tolerance);

}  // namespace cloud2csg
