#include "shape/sample/scan_defects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_ray_stream = 0x7363616e'03;
/// Ranges of one beam that differ by more than this many distances between neighbouring rays are of two surfaces, or of
/// one that is seen at less than 6 degrees.
constexpr double k_edge_steps = 10.0;
/// Twenty times the noise is the most: a formula with 1 / cosine knows no bounds.
constexpr double k_least_cosine = 0.05;

double incidence_cosine(const Ray& ray, const RayHit& hit) {
  return std::clamp(-ray.direction.dot(hit.normal), 0.0, 1.0);
}

/// Anywhere on the ray within the bounding sphere.
double outlier_range(const ScanTarget& target, const Ray& ray, const RayHit& hit, double place) {
  const double nearest_to_middle = (target.middle - ray.origin).dot(ray.direction);
  const double off_middle = (ray.origin + nearest_to_middle * ray.direction - target.middle).squaredNorm();
  const double half_chord = std::sqrt(std::max(0.0, target.radius * target.radius - off_middle));
  return half_chord > 0.0 ? nearest_to_middle + (2.0 * place - 1.0) * half_chord : hit.range;
}

bool is_at_edge(const RayHit& hit, const std::optional<RayHit>& side, double step) {
  return side && std::abs(side->range - hit.range) > k_edge_steps * step * hit.range;
}

}  // namespace

RayChances::RayChances(std::uint64_t seed, std::size_t view, std::size_t ray) {
  RandomStream random(seed, k_ray_stream, view, ray);
  loss = random.uniform();
  outlier = random.uniform();
  mixing = random.uniform();
  outlier_place = random.uniform();
  mixing_weight = random.uniform();
  beam_direction = random.uniform();
  noise = random.normal();
}

double loss_probability(const ScanOptions& options, const Ray& ray, const RayHit& hit) {
  const double angle_deg = std::acos(incidence_cosine(ray, hit)) * 180.0 / std::numbers::pi;
  const double beyond = (angle_deg - options.grazing_angle_deg) / (90.0 - options.grazing_angle_deg);
  return options.grazing_loss * std::max(0.0, beyond);
}

double noise_sigma(const ScanOptions& options, const ScanTarget& target, const Ray& ray, const RayHit& hit) {
  const double range = hit.range / (options.distance * target.radius);
  return options.noise * target.diagonal() * range * range / std::max(k_least_cosine, incidence_cosine(ray, hit));
}

Ray beam_side(const Ray& ray, double step, const RayChances& chances) {
  const double angle = 2.0 * std::numbers::pi * chances.beam_direction;
  const Vector3d first = ray.direction.unitOrthogonal();
  const Vector3d across = std::cos(angle) * first + std::sin(angle) * ray.direction.cross(first);
  return {.origin = ray.origin, .direction = (ray.direction + std::tan(0.25 * step) * across).normalized()};
}

double measured_range(const ScanOptions& options, const ScanTarget& target, const Ray& ray, const RayHit& hit,
                      const std::optional<RayHit>& side, double step, const RayChances& chances) {
  double range = hit.range + noise_sigma(options, target, ray, hit) * chances.noise;
  if (chances.outlier < options.outliers) {
    range = outlier_range(target, ray, hit, chances.outlier_place);
  } else if (chances.mixing < options.mixed_pixels && is_at_edge(hit, side, step)) {
    range += chances.mixing_weight * (side->range - hit.range);
  }
  const double quantum = options.quantisation * target.diagonal();
  if (quantum > 0.0) range = std::round(range / quantum) * quantum;
  return std::max(0.0, range);
}

}  // namespace cloud2csg
