#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace cloud2csg {

/// Regular places in a plane: rows and grids of equal steps, and full circles of equal angles.
enum class Arrangement : std::uint8_t { none, grid, circle };

struct RegularPlaces {
  std::vector<Eigen::Vector2d> places;    ///< in input order; unchanged if not in an arrangement
  std::vector<Arrangement> arrangements;  ///< by place
};

/// Moves places into exact arrangements, none by more than `tolerance`, those of most places first. An arrangement has
/// places of one kind. A row has at least three, a grid four; steps are equal, orthogonal and along the plane's axes if
/// the tolerance allows. A circle has at least three, about its own centre or exactly about one of `centres`.
/// `weights`: each place's weight in common values. Skips kinds of more than 1000 places. O(n^2 log n) for n of a kind.
/// Precondition: `kinds` and `weights` are as long as `places`; tolerance > 0.
[[nodiscard]] RegularPlaces regular_places(std::span<const Eigen::Vector2d> places, std::span<const int> kinds,
                                           std::span<const double> weights, std::span<const Eigen::Vector2d> centres,
                                           double tolerance);

}  // namespace cloud2csg
