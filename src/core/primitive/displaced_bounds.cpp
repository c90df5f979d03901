#include "core/primitive/displaced_bounds.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "core/geometry/octree.hpp"

namespace cloud2csg {
namespace {

/// Halvings of a side of the start box down to the smallest cells: 1/256.
constexpr int k_levels = 8;
/// Cells to divide per side of the bounds before the search settles for what it has.
constexpr int k_cell_budget = 256;

struct Interval {
  double low, high;
};

Interval product(const Interval& a, const Interval& b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

/// All values of the sine between two angles.
Interval sine_range(double from, double to) {
  const auto has_turn_at = [&](double angle) {
    const double turns = std::ceil((from - angle) / (2 * std::numbers::pi));
    return angle + 2 * std::numbers::pi * turns <= to;
  };
  const auto [low, high] = std::minmax({std::sin(from), std::sin(to)});
  return {has_turn_at(-0.5 * std::numbers::pi) ? -1 : low, has_turn_at(0.5 * std::numbers::pi) ? 1 : high};
}

/// A part of the start box, as far as `level` halvings led; `reach` is how far it extends in the search's direction.
struct Cell {
  Eigen::Vector3d centre;
  int level;
  double reach;
  double least_distance;  ///< of the displaced solid in the cell, or below

  /// The farther first; among equals the one that is most likely to hold a point of the solid.
  friend bool operator<(const Cell& a, const Cell& b) {
    return a.reach != b.reach ? a.reach < b.reach : a.least_distance > b.least_distance;
  }
};

class BoundsSearch {
 public:
  BoundsSearch(const Primitive& primitive, const AlignedBox& start)
      : undisplaced_(primitive),
        frequency_(primitive.displacement->frequency),
        spread_(primitive.pose.orientation.conjugate().toRotationMatrix().cwiseAbs()),
        start_(start) {
    undisplaced_.displacement.reset();
  }

  /// The largest coordinate of the solid along sign * axis, times the sign; -infinity when the solid is empty.
  [[nodiscard]] double farthest(int axis, double sign) const {
    std::priority_queue<Cell> cells;
    cells.push({start_.center(), 0, reach(start_.center(), 0, axis, sign), -1});
    for (int divided = 0; !cells.empty(); ++divided) {
      const Cell cell = cells.top();
      // Whatever else is left reaches less far.
      if (cell.level == k_levels || divided == k_cell_budget) return cell.reach;
      cells.pop();
      for (const Cell& child : children(cell, axis, sign)) {
        if (child.least_distance <= 0) cells.push(child);
      }
    }
    return -std::numeric_limits<double>::infinity();
  }

 private:
  [[nodiscard]] Eigen::Vector3d half_size(int level) const { return std::ldexp(0.5, -level) * start_.sizes(); }

  [[nodiscard]] double reach(const Eigen::Vector3d& centre, int level, int axis, double sign) const {
    return sign * centre[axis] + half_size(level)[axis];
  }

  [[nodiscard]] std::vector<Cell> children(const Cell& cell, int axis, double sign) const {
    const int level = cell.level + 1;
    OctreeLevel parts{.centres = {}, .half_size = half_size(cell.level)};
    parts.centres.push_back(cell.centre);
    parts = octants(parts);
    const std::vector<double> distances = signed_distance(undisplaced_, parts.centres);
    std::vector<Cell> result;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const Eigen::Vector3d centre = parts.centres[i];
      const double least = distances[i] - parts.radius() + least_displacement(centre, parts.half_size);
      result.push_back({centre, level, reach(centre, level, axis, sign), least});
    }
    return result;
  }

  /// The least value of the product of sines in the solid's own box around a cell of the world.
  [[nodiscard]] double least_displacement(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) const {
    const Eigen::Vector3d angle = frequency_ * undisplaced_.pose.to_local(centre);
    const Eigen::Vector3d change = frequency_ * (spread_ * half);
    Interval range{1, 1};
    for (int axis = 0; axis < 3; ++axis) {
      range = product(range, sine_range(angle[axis] - change[axis], angle[axis] + change[axis]));
    }
    return range.low;
  }

  Primitive undisplaced_;
  double frequency_;
  Eigen::Matrix3d spread_;  ///< from half sizes in the world to half sizes in the solid's frame
  AlignedBox start_;
};

}  // namespace

AlignedBox displaced_bounds(const Primitive& primitive, const AlignedBox& start) {
  assert(primitive.displacement);
  const BoundsSearch search(primitive, start);
  AlignedBox result;
  for (int axis = 0; axis < 3; ++axis) {
    result.max()[axis] = search.farthest(axis, 1);
    result.min()[axis] = -search.farthest(axis, -1);
  }
  return result;
}

}  // namespace cloud2csg
