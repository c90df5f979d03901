#include "detection/oracle.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;

constexpr double k_false_positives = 0.01;
constexpr double k_normal_quantile = 2.3263;  // exceeded by 1 % of standard normal numbers

bool is_asked(const Question& question, std::uint32_t surface) {
  return std::ranges::count(question.surfaces, surface) > 0;
}

std::vector<std::size_t> asked_points(const Scene& scene, const Question& question) {
  std::vector<std::size_t> points;
  for (std::size_t i = 0; i < scene.aligned.size(); ++i) {
    if (is_asked(question, scene.surface[i])) points.push_back(i);
  }
  return points;
}

/// The z test of `one_plane`.
double z_of_heights(const Scene& scene, const Question& question) {
  const Surface& plane = scene.surfaces[question.surfaces.back()];
  const Vector3d across = plane.axis.unitOrthogonal();
  const std::vector<std::size_t> points = asked_points(scene, question);
  Eigen::MatrixX3d planes(points.size(), 3);
  Eigen::VectorXd heights(points.size());
  Eigen::VectorXd true_heights(points.size());
  for (Eigen::Index row = 0; row < heights.size(); ++row) {
    const std::size_t i = points[static_cast<std::size_t>(row)];
    const Vector3d place = scene.aligned[i] - plane.position;
    const double sigma = scene.noise[i];
    planes.row(row) << 1 / sigma, across.dot(place) / sigma, plane.axis.cross(across).dot(place) / sigma;
    heights[row] = plane.axis.dot(place) / sigma;
    true_heights[row] = plane.axis.dot(scene.exact[i] - plane.position) / sigma;
  }
  const Eigen::VectorXd unexplained = true_heights - planes * planes.householderQr().solve(true_heights);
  const double length = unexplained.norm();
  constexpr double k_nothing = 1e-6;  // rounding of heights that a plane explains
  return length < k_nothing ? 0 : heights.dot(unexplained) / length;
}

/// Tested surface and alternative of the other tests, in sigma.
struct Spread {
  int coordinates;  ///< across the middle
  double distance;  ///< of the surface from the middle

  [[nodiscard]] double variance_around_middle() const { return 1 + distance * distance / coordinates; }
};

/// Logarithm of A.
double log_mean_exponential(int coordinates, double x) {
  const double decay = std::exp(-2 * x);
  constexpr double k_large = 50;  // from here on, the series is exact to 1e-4, and I0 will overflow
  switch (coordinates) {
    case 1:
      return x + std::log1p(decay) - std::numbers::ln2;
    case 2:
      if (x > k_large) return x - std::log(2 * std::numbers::pi * x) / 2 + 1 / (8 * x);
      return std::log(std::cyl_bessel_i(0, x));
    default:
      return x < 1e-4 ? x * x / 6 : x + std::log((1 - decay) / (2 * x));
  }
}

double log_ratio(const Spread& spread, double rho) {
  const double variance = spread.variance_around_middle();
  const double r = spread.distance;
  return log_mean_exponential(spread.coordinates, rho * r) - (rho * rho + r * r) / 2 + rho * rho / (2 * variance) +
         spread.coordinates * std::log(variance) / 2;
}

int coordinates_of(Alternative alternative) {
  switch (alternative) {
    case Alternative::around_plane:
      return 1;
    case Alternative::around_line:
      return 2;
    default:
      return 3;
  }
}

/// Distance of the surface from the middle.
double distance_from_middle(const Scene& scene, const Question& question) {
  const Surface& first = scene.surfaces[question.surfaces.front()];
  if (question.alternative != Alternative::around_plane) return first.radius;
  return -signed_distance(first, scene.surfaces[question.surfaces.back()].position) / 2;
}

double sum_of_ratios(const Scene& scene, const Question& question) {
  const Surface& surface = scene.surfaces[question.surfaces.front()];
  const double distance = distance_from_middle(scene, question);
  const double outward = surface.concave ? -1 : 1;
  double sum = 0;
  for (const std::size_t i : asked_points(scene, question)) {
    const double sigma = scene.noise[i];
    const double rho = std::abs(distance + outward * signed_distance(surface, scene.aligned[i]));
    sum += log_ratio({coordinates_of(question.alternative), distance / sigma}, rho / sigma);
  }
  return sum;
}

/// The sum for points of the alternative.
double drawn_sum(const Spread& spread, std::size_t points, RandomStream random) {
  const double sigma = std::sqrt(spread.variance_around_middle());
  double sum = 0;
  for (std::size_t i = 0; i < points; ++i) {
    double squares = 0;
    for (int k = 0; k < spread.coordinates; ++k) squares += std::pow(sigma * random.normal(), 2);
    sum += log_ratio(spread, std::sqrt(squares));
  }
  return sum;
}

}  // namespace

double oracle_statistic(const Scene& scene, const Question& question) {
  return question.alternative == Alternative::one_plane ? z_of_heights(scene, question)
                                                        : sum_of_ratios(scene, question);
}

double oracle_threshold(const Scene& scene, const Question& question) {
  if (question.alternative == Alternative::one_plane) return k_normal_quantile;
  constexpr std::size_t k_clouds = 2000;  // 20 above the threshold: the chance is right to a quarter
  constexpr std::uint64_t k_oracle_stage = 0x6f7261;
  const std::vector<std::size_t> points = asked_points(scene, question);
  const Spread spread{coordinates_of(question.alternative),
                      distance_from_middle(scene, question) / scene.noise[points.front()]};
  std::vector<double> sums(k_clouds);
  for (std::size_t k = 0; k < k_clouds; ++k)
    sums[k] = drawn_sum(spread, points.size(), RandomStream(1, k_oracle_stage, k));
  std::ranges::sort(sums);
  return sums[static_cast<std::size_t>((1 - k_false_positives) * static_cast<double>(k_clouds))];
}

}  // namespace cloud2csg::bench
