#include "paper/overlap/narrow_phase.hpp"

#include <ccd/ccd.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "core/fields/lipschitz.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/octree.hpp"

namespace cloud2csg {
namespace {

Primitive solid_of(const Primitive& primitive, const std::optional<OrientedBox>& extent) {
  if (!extent || bounds(primitive).sizes().allFinite()) return primitive;
  return {.id = primitive.id, .shape = Box{.size = 2.0 * extent->half_size}, .pose = extent->pose};
}

BodyKind kind_of(const Primitive& solid) {
  if (!is_convex(solid)) return BodyKind::field;
  if (std::holds_alternative<Sphere>(solid.shape)) return BodyKind::sphere;
  if (std::holds_alternative<HalfSpace>(solid.shape)) return BodyKind::half_space;
  return BodyKind::convex;
}

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Half-spaces with unit normals this close to opposite count as parallel: they meet over 10^9 units away, if at all.
constexpr double k_opposite_tolerance = 1e-9;

bool spheres_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const double reach = std::get<Sphere>(a.solid.shape).radius + std::get<Sphere>(b.solid.shape).radius;
  return (a.center - b.center).norm() <= reach + tolerance;
}

Eigen::Vector3d outward_normal(const OverlapBody& half_space) {
  return half_space.solid.pose.orientation * Eigen::Vector3d::UnitZ();
}

/// How far a displacement can move the surface of a distance field.
double amplitude(const OverlapBody& body) {
  return body.solid.displacement ? 1.0 : 0.0;
}

/// Two unbounded half-spaces, displaced or not. Parallel displaced ones that may touch count as overlapping.
bool half_spaces_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const Eigen::Vector3d normal = outward_normal(a);
  if ((normal + outward_normal(b)).norm() > k_opposite_tolerance) return true;
  const double gap = normal.dot(b.center - a.center);
  return gap <= tolerance + amplitude(a) + amplitude(b);
}

/// support() of a convex body, but in O(corners) for polytopes.
Eigen::Vector3d support_point(const OverlapBody& body, const Eigen::Vector3d& direction) {
  if (body.corners.empty()) return support(body.solid, direction);
  return *std::max_element(body.corners.begin(), body.corners.end(),
                           [&direction](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); });
}

bool half_space_overlaps(const OverlapBody& half_space, const OverlapBody& convex, double tolerance) {
  const Eigen::Vector3d normal = outward_normal(half_space);
  const Eigen::Vector3d deepest = support_point(convex, -normal);
  return normal.dot(deepest - half_space.center) <= tolerance;
}

bool is_any_half_space(const OverlapBody& body) {
  return std::holds_alternative<HalfSpace>(body.solid.shape);
}

// libccd has GJK and Minkowski portal refinement (MPR). On touching solids, tolerance 1e-6 of their size, its GJK
// misses 20 to 70 % of the contacts, because its simplex tests compare squared lengths with an absolute epsilon. Its
// MPR misses none of 280 000, needs fewer support points and ends by itself.

constexpr unsigned long k_max_iterations = 1000;  // NOLINT(google-runtime-int): libccd's type
/// Progress of the portal at which MPR stops, in units of the pair's size: near the resolution of double.
constexpr double k_portal_tolerance = 1e-13;

/// A body in libccd's frame: the pair is at the origin and of unit size, since libccd's epsilons are absolute.
struct CcdBody {
  const OverlapBody& body;
  double inflation;
  Eigen::Vector3d origin;
  double scale;
};

ccd_vec3_t to_ccd(const CcdBody& object, const Eigen::Vector3d& world) {
  const Eigen::Vector3d scaled = object.scale * (world - object.origin);
  return {{scaled.x(), scaled.y(), scaled.z()}};
}

void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* result) {
  const auto& body = *static_cast<const CcdBody*>(object);
  Eigen::Vector3d towards(direction->v[0], direction->v[1], direction->v[2]);
  const double length = towards.norm();
  towards = length > 0 ? Eigen::Vector3d(towards / length) : Eigen::Vector3d::UnitX();
  *result = to_ccd(body, support_point(body.body, towards) + body.inflation * towards);
}

void ccd_center(const void* object, ccd_vec3_t* result) {
  const auto& body = *static_cast<const CcdBody*>(object);
  *result = to_ccd(body, body.body.center);
}

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

/// Cells not proved to be outside. NaN proves nothing. `values`: the largest field so far at each centre.
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

/// One Newton step towards f_a <= 0 and f_b <= 0: the shortest one that solves the violated constraints, linearised.
/// Damping keeps the step finite where solids touch and the gradients are opposite.
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

/// Whether Newton's method from `start` reaches a point within `reach` of both solids. Finds contacts far smaller than
/// any cell. A failure proves nothing.
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

/// The cell nearest to both solids; values.size() when all values are NaN.
std::size_t most_promising(const std::vector<double>& values) {
  std::size_t best = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i]) && (best == values.size() || values[i] < values[best])) best = i;
  }
  return best;
}

/// Whether two bounded convex bodies, each grown by half the tolerance, intersect, by Minkowski portal refinement.
bool convex_bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const AlignedBox both = a.bounds.merged(b.bounds);
  const double size = both.diagonal().norm() + tolerance;
  if (size == 0) return true;
  const double half = tolerance / 2;
  const CcdBody first{.body = a, .inflation = half, .origin = both.center(), .scale = 1 / size};
  const CcdBody second{.body = b, .inflation = half, .origin = both.center(), .scale = 1 / size};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccd_support;
  ccd.center1 = ccd.center2 = ccd_center;
  ccd.max_iterations = k_max_iterations;
  ccd.mpr_tolerance = k_portal_tolerance;
  return ccdMPRIntersect(&first, &second, &ccd) != 0;
}

/// Whether some point is within half the tolerance of two bodies with bounds in common. Branch and bound over the
/// common bounds drops a cell when a field's Lipschitz constant proves it to be outside of one solid.
/// "No" is proven where the Lipschitz constants are (all shapes but expressions, whose constant is estimated). "Yes" is
/// proven by a point, within the fields' own accuracy: a displaced or expression field is divided by its Lipschitz
/// constant, so such a solid may count as larger by tolerance * lipschitz / 2. When the budget of evaluations ends
/// first, the gap is smaller than the cells can tell (about 1/500 of the common bounds), and the answer is yes: an
/// extra edge costs time, a missing edge costs the right tree. @throws Cancelled
bool fields_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run) {
  const double reach = tolerance / 2;
  const AlignedBox region = grown(a.bounds, reach).intersection(grown(b.bounds, reach));
  if (region.isEmpty()) return false;
  if (!region.sizes().allFinite()) return true;  // no search ends there: rather an extra edge

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

}  // namespace

OverlapBody make_overlap_body(const Primitive& primitive, const std::optional<OrientedBox>& extent) {
  OverlapBody body{.solid = solid_of(primitive, extent), .bounds = {}};
  body.bounds = bounds(body.solid);
  body.kind = kind_of(body.solid);
  body.center = body.solid.pose.position;
  body.lipschitz = lipschitz_estimate(body.solid);
  if (const auto* polytope = std::get_if<Polytope>(&body.solid.shape); polytope != nullptr && is_convex(body.solid)) {
    body.corners = corners(*polytope);
    for (Eigen::Vector3d& corner : body.corners) corner = body.solid.pose.to_world(corner);
    body.center = mean(body.corners);
  }
  return body;
}

bool bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run) {
  if (is_any_half_space(a) && is_any_half_space(b)) return half_spaces_overlap(a, b, tolerance);
  if (a.kind == BodyKind::field || b.kind == BodyKind::field) return fields_overlap(a, b, tolerance, run);
  if (a.kind == BodyKind::half_space) return half_space_overlaps(a, b, tolerance);
  if (b.kind == BodyKind::half_space) return half_space_overlaps(b, a, tolerance);
  if (a.kind == BodyKind::sphere && b.kind == BodyKind::sphere) return spheres_overlap(a, b, tolerance);
  return convex_bodies_overlap(a, b, tolerance);
}

}  // namespace cloud2csg
