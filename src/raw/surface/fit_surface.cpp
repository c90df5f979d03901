#include <ceres/tiny_solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "cloud2csg/advanced/surface.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/subset.hpp"
#include "raw/surface/chart.hpp"
#include "raw/surface/robust_loss.hpp"
#include "raw/surface/unit_frame.hpp"

namespace cloud2csg {
namespace {

constexpr int k_most_rounds = 6;            // under Tukey's loss; the noise settles after two or three
constexpr double k_settled = 0.02;          // relative change of the noise
constexpr double k_smallest_noise = 1e-12;  // in the unit frame

/// Noise-scaled residuals for ceres::TinySolver, which suits few unknowns and sets up 4000 residuals in no time.
struct RobustDistances {
  using Scalar = double;
  // NOLINTNEXTLINE(readability-identifier-naming): the solver's names
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  const Chart& chart;
  std::span<const Eigen::Vector3d> points;
  std::span<const double> precisions;
  double noise;
  RobustLoss loss;
  std::size_t held;

  // NOLINTBEGIN(readability-identifier-naming): the solver's names
  [[nodiscard]] int NumResiduals() const { return static_cast<int>(points.size()); }
  [[nodiscard]] int NumParameters() const { return static_cast<int>(chart.unknowns() - held); }
  // NOLINTEND(readability-identifier-naming)

  /// All unknowns, from those that are not held.
  [[nodiscard]] Chart::Row all(const double* free) const {
    Chart::Row row = chart.start();
    std::copy_n(free, chart.unknowns() - held, row.begin() + static_cast<std::ptrdiff_t>(held));
    return row;
  }

  bool operator()(const double* free, double* residuals, double* jacobian) const {
    const std::size_t count = chart.unknowns();
    const Chart::Row unknowns = all(free);
    const Chart::Place place = chart.at({unknowns.data(), count});
    Chart::Row slopes = {};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance =
          jacobian == nullptr ? chart.distance(place, points[i]) : chart.distance(place, points[i], slopes);
      const auto [value, slope] = loss(distance * precisions[i] / noise);
      residuals[i] = value;
      if (jacobian == nullptr) continue;
      for (std::size_t k = held; k < count; ++k) {
        jacobian[(k - held) * points.size() + i] = slope * slopes[k] * precisions[i] / noise;
      }
    }
    return true;
  }
};

using Unknowns = Eigen::VectorXd;

/// Tolerances of the cost, in squared noise. A change of c moves the unknowns by sqrt(c) of their uncertainty.
constexpr double k_rough = 1e-2;
constexpr double k_precise = 1e-6;

/// The unknowns that fit best. `distances` tells which are held.
Chart::Row solve(const RobustDistances& distances, double tolerance) {
  const Chart::Row start = distances.chart.start();
  Unknowns free = Eigen::Map<const Unknowns>(start.data() + distances.held, distances.NumParameters());
  ceres::TinySolver<RobustDistances> solver;
  solver.options.function_tolerance = tolerance;
  solver.options.max_num_iterations = 50;
  solver.Solve(distances, &free);
  return distances.all(free.data());
}

double measured_noise(const Surface& surface, std::span<const Eigen::Vector3d> points,
                      std::span<const double> precisions) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    distances.push_back(std::abs(signed_distance(surface, points[i])) * precisions[i]);
  }
  return robust_deviation(distances);
}

struct Solution {
  Surface surface;
  double noise;
};

class Fitter {
 public:
  Fitter(std::vector<Eigen::Vector3d> points, std::vector<double> precisions, double floor, std::optional<double> noise,
         HeldValue held)
      : points_(std::move(points)), precisions_(std::move(precisions)), floor_(floor), given_(noise), held_(held) {}

  [[nodiscard]] std::optional<Solution> fit(const Surface& start) const {
    return given_ ? fit_within(start, *given_) : fit_and_measure(start);
  }

  [[nodiscard]] SurfaceUncertainty uncertainty(const Solution& solution, double rms) const;

 private:
  /// Starts with a wide loss where the points of an inaccurate start would not count otherwise, then narrows it.
  [[nodiscard]] std::optional<Solution> fit_within(const Surface& start, double noise) const {
    std::optional<Surface> surface = start;
    const double measured = measured_noise(start, points_, precisions_);
    constexpr std::array k_factors{8.0, 2.0, 1.0};
    for (std::size_t k = 0; k < k_factors.size(); ++k) {
      if (!surface) return std::nullopt;
      if (k + 1 < k_factors.size() && measured <= k_factors[k + 1] * noise) continue;
      const double factor = k_factors[k];
      surface = improved(*surface, factor * noise, {LossType::tukey, k_tukey}, factor > 1 ? k_rough : k_precise);
    }
    if (!surface) return std::nullopt;
    return Solution{.surface = *surface, .noise = noise};
  }

  [[nodiscard]] std::optional<Solution> fit_and_measure(const Surface& start) const {
    // Under Huber's loss every point pulls, which corrects even a distant start.
    double noise = std::max(measured_noise(start, points_, precisions_), floor_);
    std::optional<Surface> surface = improved(start, noise, {LossType::huber, k_huber}, k_rough);
    bool is_settled = false;
    for (int round = 0; surface && !is_settled && round < k_most_rounds; ++round) {
      const double measured = std::max(measured_noise(*surface, points_, precisions_), floor_);
      // Equality with the noise of the first loss means nothing.
      is_settled = round + 1 == k_most_rounds || (round > 0 && std::abs(measured - noise) < k_settled * noise);
      noise = measured;
      surface = improved(*surface, noise, {LossType::tukey, k_tukey}, is_settled ? k_precise : k_rough);
    }
    if (!surface) return std::nullopt;
    return Solution{.surface = *surface, .noise = noise};
  }

  [[nodiscard]] std::optional<Surface> improved(const Surface& surface, double noise, const RobustLoss& loss,
                                                double tolerance) const {
    const Chart chart(surface);
    const Chart::Row unknowns = solve({.chart = chart,
                                       .points = points_,
                                       .precisions = precisions_,
                                       .noise = noise,
                                       .loss = loss,
                                       .held = chart.held(held_)},
                                      tolerance);
    const Chart::Place place = chart.at({unknowns.data(), chart.unknowns()});
    if (!chart.is_surface(place)) return std::nullopt;
    return chart.surface(place);
  }

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> precisions_;
  double floor_;
  std::optional<double> given_;
  HeldValue held_;
};

/// Standard deviation in the worst direction of some unknowns; infinite without a covariance.
double worst_deviation(const std::optional<Eigen::MatrixXd>& covariance, Eigen::Index begin, Eigen::Index count) {
  if (count == 0) return 0;
  if (!covariance) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(covariance->block(begin, begin, count, count),
                                                             Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(parts.eigenvalues().maxCoeff(), 0.0));
}

/// Absent if some unknowns are undetermined.
std::optional<Eigen::MatrixXd> inverse_of(const Eigen::MatrixXd& information) {
  constexpr double k_singular = 1e-13;
  const Eigen::LDLT<Eigen::MatrixXd> parts(information);
  const bool is_regular = parts.info() == Eigen::Success && parts.isPositive() &&
                          parts.vectorD().minCoeff() > k_singular * parts.vectorD().maxCoeff();
  if (!is_regular) return std::nullopt;
  return parts.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
}

SurfaceUncertainty Fitter::uncertainty(const Solution& solution, double rms) const {
  const Chart chart(solution.surface);
  const Chart::Row start = chart.start();
  const Chart::Place place = chart.at({start.data(), chart.unknowns()});
  const auto count = static_cast<Eigen::Index>(chart.unknowns());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Chart::Row slopes = {};
  Eigen::Index inliers = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (std::abs(chart.distance(place, points_[i], slopes)) * precisions_[i] > k_tukey * solution.noise) continue;
    const auto row = Eigen::Map<const Eigen::VectorXd>(slopes.data(), count);
    information.noalias() += precisions_[i] * precisions_[i] * row * row.transpose();
    ++inliers;
  }
  const auto held = static_cast<Eigen::Index>(chart.held(held_));
  const Eigen::Index free = count - held;
  std::optional<Eigen::MatrixXd> covariance;  // of those that are not held
  if (inliers > free) covariance = inverse_of(information.bottomRightCorner(free, free));
  if (covariance) *covariance *= rms * rms * static_cast<double>(inliers) / static_cast<double>(inliers - free);

  const auto tilts = static_cast<Eigen::Index>(chart.tilts());
  const auto shifts = static_cast<Eigen::Index>(chart.shifts());
  const auto sizes = tilts + shifts;
  const auto worst = [&](Eigen::Index begin, Eigen::Index end) {
    return worst_deviation(covariance, std::max<Eigen::Index>(begin - held, 0),
                           std::max<Eigen::Index>(end - std::max(begin, held), 0));
  };
  const double first = worst(sizes, std::min(count, sizes + 1));
  const double second = worst(sizes + 1, count);
  const bool is_cone = solution.surface.type == SurfaceType::cone;
  return {.position = worst(tilts, sizes),
          .axis = worst(0, tilts),
          .radius = is_cone ? first / std::cos(solution.surface.half_angle) : first,
          .half_angle = is_cone ? second : 0,
          .minor_radius = is_cone ? 0 : second};
}

}  // namespace

std::optional<SurfaceFit> fit_surface(const Surface& start, std::span<const Eigen::Vector3d> points,
                                      const FitOptions& options) {
  assert(std::abs(start.axis.norm() - 1) < 1e-6);
  if (points.size() < static_cast<std::size_t>(Chart(start).unknowns())) return std::nullopt;
  assert(options.precisions.empty() || options.precisions.size() == points.size());
  const std::size_t most = std::max<std::size_t>(options.most_points, Chart::k_most_unknowns);
  const std::vector<Eigen::Vector3d> some = some_of(points, most);
  const auto precision = [&](std::size_t i) { return options.precisions.empty() ? 1 : options.precisions[i]; };
  std::vector<double> precisions =
      options.precisions.empty() ? std::vector<double>(some.size(), 1) : some_of(options.precisions, most);
  const UnitFrame frame = unit_frame(some);
  // Coordinates far from the origin carry rounding errors, so smaller residuals have no meaning.
  const double rounding = std::numeric_limits<double>::epsilon() * frame.origin.norm() / frame.scale;
  const double floor = std::max(k_smallest_noise, 4 * rounding);
  const auto noise = options.noise ? std::optional(std::max(*options.noise / frame.scale, floor)) : std::nullopt;
  const Fitter fitter(to_frame(frame, some), std::move(precisions), floor, noise, options.held);
  const std::optional<Solution> solution = fitter.fit(to_frame(frame, start));
  if (!solution) return std::nullopt;

  SurfaceFit fit{.surface = from_frame(frame, solution->surface), .noise = solution->noise * frame.scale};
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = signed_distance(fit.surface, points[i]) * precision(i);
    if (std::abs(distance) > k_tukey * fit.noise) continue;
    squares += distance * distance;
    ++fit.inliers;
  }
  if (fit.inliers == 0) return std::nullopt;
  fit.rms = std::sqrt(squares / static_cast<double>(fit.inliers));
  fit.uncertainty = fitter.uncertainty(*solution, fit.rms / frame.scale);
  fit.uncertainty.position *= frame.scale;
  fit.uncertainty.radius *= frame.scale;
  fit.uncertainty.minor_radius *= frame.scale;
  return fit;
}

}  // namespace cloud2csg
