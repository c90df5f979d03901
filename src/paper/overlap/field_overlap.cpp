#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/boxes.hpp"
#include "core/geometry/octree.hpp"
#include "paper/overlap/narrow_phase.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_evaluation_budget = 200'000;  ///< points per pair; 5 ms for shapes, 50 ms for expressions
constexpr int k_initial_cells = 4;                    ///< along the longest side of the common bounds
constexpr int k_descent_steps = 24;

/// A body's field divided by its Lipschitz constant: a lower bound of the distance to the solid, of slope 1 at most.
std::vector<double> distance_bound(const OverlapBody& body, PointsView points) {
  std::vector<double> values = signed_distance(body.solid, points);
  for (double& value : values) value /= body.lipschitz;
  return values;
}

OctreeLevel initial_cells(const AlignedBox& region) {
  const double side = std::max(region.sizes().maxCoeff() / k_initial_cells, 1e-300);
  return lattice(region, (region.sizes() / side).array().ceil().max(1.0).cast<int>().matrix());
}

/// Halves the cells along their long sides, so that they approach cubes.
OctreeLevel split(const OctreeLevel& cells) {
  OctreeLevel halves = cells;
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.half_size[axis] > 0.5 * cells.half_size.maxCoeff()) halves = halved(halves, axis);
  }
  return halves;
}

/// The cells that the field does not prove to be outside. Not-a-number proves nothing. `values` gets the fields at the
/// centres of the cells that stay, the larger of the old value and this field's.
struct Filtered {
  Points centres;
  std::vector<double> values;
};

Filtered drop_outside(const OverlapBody& body, const Filtered& cells, double reach) {
  Filtered kept;
  const std::vector<double> bound = distance_bound(body, cells.centres);
  for (std::size_t i = 0; i < cells.centres.size(); ++i) {
    if (bound[i] > reach) continue;
    kept.centres.push_back(cells.centres[i]);
    kept.values.push_back(std::isnan(bound[i]) ? bound[i] : std::max(bound[i], cells.values[i]));
  }
  return kept;
}

/// One Newton step towards f_a <= 0 and f_b <= 0: the shortest step that solves the violated constraints, linearised.
/// Where solids touch the two gradients are opposite; the damping keeps the step finite there.
Eigen::Vector3d newton_step(double value_a, const Eigen::Vector3d& slope_a, double value_b,
                            const Eigen::Vector3d& slope_b) {
  constexpr double k_damping = 1e-12;
  if (value_b <= 0) return -value_a * slope_a / (slope_a.squaredNorm() + k_damping);
  if (value_a <= 0) return -value_b * slope_b / (slope_b.squaredNorm() + k_damping);
  Eigen::Matrix<double, 2, 3> slopes;
  slopes << slope_a.transpose(), slope_b.transpose();
  const Eigen::Matrix2d normal = slopes * slopes.transpose() + k_damping * Eigen::Matrix2d::Identity();
  return -slopes.transpose() * normal.inverse() * Eigen::Vector2d(value_a, value_b);
}

/// Whether Newton's method from `start` ends at a point within `reach` of both solids. Finds contacts that are far
/// smaller than any cell; proves nothing when it fails.
bool descent_finds_overlap(const OverlapBody& a, const OverlapBody& b, const Eigen::Vector3d& start,
                           const AlignedBox& region, double reach) {
  Points point(1);
  point.set(0, start);
  const double longest_step = region.diagonal().norm() / 4;
  for (int step = 0; step < k_descent_steps; ++step) {
    const double value_a = distance_bound(a, point)[0];
    const double value_b = distance_bound(b, point)[0];
    if (value_a <= reach && value_b <= reach) return true;
    Eigen::Vector3d move = newton_step(value_a, gradient(a.solid, point)[0] / a.lipschitz, value_b,
                                       gradient(b.solid, point)[0] / b.lipschitz);
    const double length = move.norm();
    if (!(length > 0) || !std::isfinite(length)) return false;
    if (length > longest_step) move *= longest_step / length;
    point.set(0, (point[0] + move).cwiseMax(region.min()).cwiseMin(region.max()));
  }
  return false;
}

/// The cell nearest to both solids; cells.size() when no field is a number anywhere.
std::size_t most_promising(const std::vector<double>& values) {
  std::size_t best = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i]) && (best == values.size() || values[i] < values[best])) best = i;
  }
  return best;
}

}  // namespace

bool fields_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run) {
  const double reach = tolerance / 2;
  const AlignedBox region = grown(a.bounds, reach).intersection(grown(b.bounds, reach));
  if (region.isEmpty()) return false;
  if (!region.sizes().allFinite()) return true;  // no search can end there: rather an edge too many

  OctreeLevel cells = initial_cells(region);
  for (std::size_t evaluations = 0; !cells.centres.empty(); cells = split(cells)) {
    run.throw_if_stopped();
    evaluations += cells.centres.size();
    if (evaluations > k_evaluation_budget) return true;
    const double radius = cells.radius();
    const std::vector<double> lowest(cells.centres.size(), -std::numeric_limits<double>::infinity());
    const Filtered near_a = drop_outside(a, {.centres = cells.centres, .values = lowest}, reach + radius);
    Filtered near_both = drop_outside(b, near_a, reach + radius);
    if (const std::size_t best = most_promising(near_both.values); best < near_both.values.size()) {
      if (near_both.values[best] <= reach) return true;
      if (descent_finds_overlap(a, b, near_both.centres[best], region, reach)) return true;
    }
    cells.centres = std::move(near_both.centres);
  }
  return false;
}

}  // namespace cloud2csg
