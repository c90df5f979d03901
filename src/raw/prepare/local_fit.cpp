#include "raw/prepare/local_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/base/robust_deviation.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Added to k_around for an angle error, about 2 noise / (radius sqrt(neighbours)), of three degrees.
constexpr double k_neighbours_a_noise = 60.0;
constexpr int k_trials = 16;
constexpr double k_tukey = 4.685;  // deviations beyond which the biweight is zero: 95 % efficient for normal noise
/// In tolerances: with less deviation there is only one plane.
constexpr double k_flat = 0.5;
constexpr std::uint64_t k_trial_stage = 0x706c'616e'65;

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Plane {
  Vector3d middle;
  Vector3d normal;

  [[nodiscard]] double height(const Vector3d& place) const { return normal.dot(place - middle); }
};

class Moments {
 public:
  void add(const Vector3d& place, double weight) {
    weight_ += weight;
    first_ += weight * place;
    second_ += weight * place * place.transpose();
  }
  [[nodiscard]] Plane plane() const {
    const Vector3d middle = first_ / weight_;
    const Matrix3d covariance = second_ / weight_ - middle * middle.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver =
        Eigen::SelfAdjointEigenSolver<Matrix3d>().computeDirect(covariance);
    const Vector3d normal = solver.eigenvectors().col(0);
    return {middle, normal.allFinite() && normal.squaredNorm() > 0.5 ? normal.normalized() : Vector3d::UnitZ().eval()};
  }
  [[nodiscard]] double weight() const { return weight_; }

 private:
  double weight_ = 0.0;
  Vector3d first_ = Vector3d::Zero();
  Matrix3d second_ = Matrix3d::Zero();
};

/// Places relative to the central point.
using Places = std::vector<Vector3d>;

double truncated_cost(const Places& places, const Plane& plane, double tolerance) {
  double cost = 0.0;
  for (const Vector3d& place : places) {
    const double ratio = plane.height(place) / tolerance;
    cost += std::min(1.0, ratio * ratio);
  }
  return cost;
}

/// Through three of the places, in every second trial through the central one, which is the first.
std::optional<Plane> plane_of_trial(const Places& places, int trial, RandomStream& random) {
  const Vector3d& a = places[random.below(places.size())];
  const Vector3d& b = places[random.below(places.size())];
  const Vector3d& c = trial % 2 == 0 ? places[random.below(places.size())] : places[0];
  const Vector3d normal = (b - a).cross(c - a);
  const double length = normal.norm();
  if (!(length > 0.05 * (b - a).norm() * (c - a).norm())) return std::nullopt;
  return Plane{a, normal / length};
}

/// The best plane through three of the places. The central point (the origin) must be near it.
Plane best_of_trials(const Places& places, const Plane& start, double tolerance, RandomStream& random) {
  Plane best = start;
  // The start is invalid if it misses the central point.
  double least = std::abs(start.height(Vector3d::Zero())) > tolerance ? static_cast<double>(places.size())
                                                                      : truncated_cost(places, start, tolerance);
  for (int trial = 0; trial < k_trials; ++trial) {
    const std::optional<Plane> plane = plane_of_trial(places, trial, random);
    if (!plane || std::abs(plane->height(Vector3d::Zero())) > tolerance) continue;
    const double cost = truncated_cost(places, *plane, tolerance);
    if (cost < least) {
      least = cost;
      best = *plane;
    }
  }
  return best;
}

struct HalfPlane {
  Plane plane;
  double deviation;
};

/// The plane through three of the places with the least median distance (least median of squares: Rousseeuw 1984). Half
/// of the places determine it, so it follows one side of a wall that is thinner than the neighbourhood.
HalfPlane plane_of_half(const Places& places, RandomStream& random) {
  Moments moments;
  for (const Vector3d& place : places) moments.add(place, 1.0);
  HalfPlane best{.plane = moments.plane(), .deviation = std::numeric_limits<double>::infinity()};
  std::vector<double> heights(places.size());
  const auto consider = [&](const Plane& plane) {
    for (std::size_t i = 0; i < places.size(); ++i) heights[i] = std::abs(plane.height(places[i]));
    const double deviation = robust_deviation(heights);
    if (deviation < best.deviation) best = {.plane = plane, .deviation = deviation};
  };
  consider(best.plane);
  for (int trial = 0; trial < k_trials; ++trial) {
    if (const std::optional<Plane> plane = plane_of_trial(places, trial, random)) consider(*plane);
  }
  // Three points fit a small sample better than its truth does (Rousseeuw and Leroy 1987, chapter 5).
  best.deviation *= 1.0 + 5.0 / static_cast<double>(places.size() - 3);
  return best;
}

double deviation_of(const Places& places, const Plane& plane) {
  double sum = 0.0;
  for (const Vector3d& place : places) sum += plane.height(place) * plane.height(place);
  return std::sqrt(sum / static_cast<double>(places.size()));
}

Plane refined(const Places& places, Plane plane, double tolerance) {
  for (int step = 0; step < k_rounds; ++step) {
    Moments moments;
    for (const Vector3d& place : places) {
      const double ratio = plane.height(place) / (1.5 * tolerance);
      const double rest = 1.0 - ratio * ratio;
      if (rest > 0.0) moments.add(place, rest * rest);
    }
    if (!(moments.weight() > 2.0)) break;
    plane = moments.plane();
  }
  return plane;
}

LocalPlane fit(const Places& places, double tolerance, RandomStream& random) {
  Moments moments;
  for (const Vector3d& place : places) moments.add(place, 1.0);
  Plane plane = moments.plane();
  if (deviation_of(places, plane) > k_flat * tolerance) {
    plane = refined(places, best_of_trials(places, plane, tolerance, random), tolerance);
  }
  LocalPlane result{.normal = plane.normal, .offset = plane.height(Vector3d::Zero())};
  double sum = 0.0;
  double explained = 0.0;
  for (const Vector3d& place : places) {
    const double height = plane.height(place);
    if (std::abs(height) > tolerance) continue;
    sum += height * height;
    explained += 1.0;
  }
  result.deviation = explained > 0.0 ? std::sqrt(sum / explained) : 0.0;
  result.support = explained / static_cast<double>(places.size());
  return result;
}

Vector6d monomials(double u, double v) {
  Vector6d terms;
  terms << 1.0, u, v, u * u, u * v, v * v;
  return terms;
}

}  // namespace

LocalPlane fit_local_plane(const Points& points, std::size_t point, std::span<const std::uint32_t> neighbours,
                           double tolerance) {
  if (neighbours.size() < 3 || !(tolerance > 0.0)) return {};
  const Vector3d middle = points[point];
  thread_local Places places;
  places.assign(1, Vector3d::Zero());
  for (const std::uint32_t neighbour : neighbours) places.emplace_back(points[neighbour] - middle);
  RandomStream random(0, k_trial_stage, point);
  return fit(places, tolerance, random);
}

LocalPlane fit_local_plane(const Points& points, std::size_t point, const NeighbourTable& neighbours, double noise,
                           double bend) {
  if (neighbours.width < 3) return {};
  const double radius = neighbours.distances_of(point).back();
  return fit_local_plane(points, point, neighbours.of(point), std::max(k_deviations * noise, bend * radius));
}

std::vector<LocalPlane> fit_local_planes(const Points& points, const NeighbourTable& neighbours, double noise,
                                         double bend, const RunContext& run, const StageShare& share) {
  std::vector<LocalPlane> planes(points.size());
  for_each_index_by_chunks(points.size(), k_chunk_points, run, share,
                           [&](std::size_t i) { planes[i] = fit_local_plane(points, i, neighbours, noise, bend); });
  return planes;
}

std::size_t plane_neighbours(const Scale& scale) {
  const double more = k_neighbours_a_noise * std::max(0.0, scale.noise / scale.spacing - 0.1);
  return k_around + static_cast<std::size_t>(std::min(more, 3.0 * k_around));
}

LocalFits fit_locally(const PointCloud& cloud, std::size_t width, double noise, const RunContext& run,
                      const StageShare& share) {
  const CentredPoints local = centred(cloud.positions);
  LocalFits fits{.order = {}, .points = Points(cloud.size()), .centre = local.centre, .neighbours = {}, .planes = {}};
  const NeighbourTree first(local.points);
  fits.order.assign(first.order().begin(), first.order().end());
  for (std::size_t i = 0; i < fits.order.size(); ++i) fits.points.set(i, local.points[fits.order[i]]);
  const NeighbourTree tree(fits.points);
  fits.neighbours = find_neighbours(fits.points, tree, width, run, share.part(0, 0.5));
  fits.planes = fit_local_planes(fits.points, fits.neighbours, noise, k_bend_tolerance, run, share.part(0.5, 1));
  return fits;
}

double quadric_deviation(const Points& points, std::span<const std::uint32_t> indices) {
  const Vector3d first = points[indices[0]];
  Places around;
  for (const std::uint32_t i : indices) around.emplace_back(points[i] - first);
  RandomStream random(0, k_trial_stage, indices[0]);
  const auto [plane, start] = plane_of_half(around, random);
  const Vector3d u = plane.normal.unitOrthogonal();
  const Vector3d v = plane.normal.cross(u);
  double radius = 0.0;
  for (const Vector3d& place : around) radius = std::max(radius, (place - plane.middle).norm());
  if (!(radius > 0.0)) return 0.0;
  Places places;
  for (const Vector3d& relative : around) {
    const Vector3d place = (relative - plane.middle) / radius;
    places.emplace_back(u.dot(place), v.dot(place), plane.normal.dot(place));
  }
  std::vector<double> residuals(places.size());
  Vector6d quadric = Vector6d::Zero();
  double reach = std::max(k_tukey * start / radius, 1e-14);
  double deviation = 0.0;
  for (int step = 0; step <= k_rounds; ++step) {
    Matrix6d normal_matrix = 1e-12 * Matrix6d::Identity();
    Vector6d right = Vector6d::Zero();
    for (const Vector3d& place : places) {
      const Vector6d terms = monomials(place.x(), place.y());
      const double ratio = (place.z() - quadric.dot(terms)) / reach;
      const double rest = std::max(0.0, 1.0 - ratio * ratio);
      normal_matrix += rest * rest * terms * terms.transpose();
      right += rest * rest * place.z() * terms;
    }
    quadric = normal_matrix.ldlt().solve(right);
    for (std::size_t i = 0; i < places.size(); ++i) {
      residuals[i] = std::abs(places[i].z() - quadric.dot(monomials(places[i].x(), places[i].y())));
    }
    deviation = robust_deviation(residuals);
    reach = std::max(k_tukey * deviation, 1e-14);
  }
  const auto count = static_cast<double>(places.size());
  return radius * deviation * std::sqrt(count / (count - 6.0));
}

}  // namespace cloud2csg
