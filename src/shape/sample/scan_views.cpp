#include "shape/sample/scan_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloud2csg/error.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::uint64_t k_view_stream = 0x7363616e'01;
constexpr std::uint64_t k_turn_stream = 0x7363616e'02;

Vector3d normal_vector(RandomStream& random) {
  return {random.normal(), random.normal(), random.normal()};  // braces: in this order
}

/// A uniformly distributed orientation.
Quaterniond random_turn(RandomStream& random) {
  const Vector3d imaginary = normal_vector(random);
  const Quaterniond orientation(random.normal(), imaginary.x(), imaginary.y(), imaginary.z());
  return orientation.norm() > 0.0 ? orientation.normalized() : Quaterniond::Identity();
}

/// The i-th of n directions: equal steps in height, the golden angle in longitude.
Vector3d spiral_direction(std::size_t i, std::size_t n) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double height = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(n);
  const double across = std::sqrt(std::max(0.0, 1.0 - height * height));
  const double longitude = golden_angle * static_cast<double>(i);
  return {across * std::cos(longitude), across * std::sin(longitude), height};
}

/// The direction from the part to each sensor.
std::vector<Vector3d> view_directions(const ScanOptions& options) {
  RandomStream random(options.seed, k_turn_stream);
  const Quaterniond turn =
      options.on_table ? Quaterniond(Eigen::AngleAxisd(2.0 * std::numbers::pi * random.uniform(), Vector3d::UnitZ()))
                       : random_turn(random);
  const std::size_t steps = options.on_table ? 2 * options.views : options.views;  // the first half is above
  std::vector<Vector3d> directions;
  directions.reserve(options.views);
  for (std::size_t i = 0; i < options.views; ++i) directions.emplace_back(turn * spiral_direction(i, steps));
  return directions;
}

/// A small rotation about the middle of the part, then a shift.
Pose misplacement(const ScanTarget& target, const ScanOptions& options, RandomStream& random) {
  const double angle = options.rotation_deg * std::numbers::pi / 180.0 * random.normal();
  const Vector3d axis = normal_vector(random).stableNormalized();
  const Vector3d shift = options.translation * target.diagonal() * normal_vector(random);
  if (angle == 0.0 && shift.isZero(0.0)) return {};  // avoids even rounding
  const Quaterniond turn(Eigen::AngleAxisd(angle, axis));
  return {.position = target.middle + shift - turn * target.middle, .orientation = turn};
}

using Eigen::Vector3d;

constexpr std::uint64_t k_ray_stream = 0x7363616e'03;
/// A larger difference in a beam's ranges, in steps between rays, means two surfaces, or one at less than 6 degrees.
constexpr double k_edge_steps = 10.0;
/// Limits 1 / cosine, and thus the noise to twenty times.
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

std::vector<View> place_views(const ScanTarget& target, const ScanOptions& options) {
  const std::vector<Vector3d> directions = view_directions(options);
  std::vector<View> views;
  for (std::size_t i = 0; i < options.views; ++i) {
    RandomStream random(options.seed, k_view_stream, i);
    const Vector3d& outward = directions[i];
    const Vector3d position = target.middle + options.distance * target.radius * outward;
    View view{.sensor = pose_from_axis(position, -outward),
              .misplacement = {},
              .column_shift = random.uniform(),
              .row_shift = random.uniform()};
    view.misplacement = misplacement(target, options, random);
    views.push_back(view);
  }
  return views;
}

Raster make_raster(const ScanOptions& options, double step) {
  constexpr double k_most_rays_a_side = 1e6;
  const double half_angle = options.field_of_view_deg > 0.0 ? options.field_of_view_deg * std::numbers::pi / 360.0
                                                            : std::asin(1.0 / options.distance);
  const double side = std::floor(2.0 * half_angle / step);
  if (!(side <= k_most_rays_a_side)) {
    throw Error({.where = options.angular_step_deg > 0.0 ? "angular_step_deg" : "count",
                 .expected = fmt::format("expected no more than {:.0f} rays across a view, found {:.3g}",
                                         k_most_rays_a_side, side)});
  }
  if (side < 1) return {.step = 2.0 * half_angle, .side = 1};
  return {.step = step, .side = static_cast<std::size_t>(side)};
}

Ray ray_of(const View& view, const Raster& raster, std::size_t index) {
  const double column = static_cast<double>(index % raster.side) + view.column_shift;
  const std::size_t whole_rows = index / raster.side;
  const double row = static_cast<double>(whole_rows) + view.row_shift;
  const double half_angle = 0.5 * static_cast<double>(raster.side) * raster.step;
  const double azimuth = column * raster.step - half_angle;
  const double elevation = row * raster.step - half_angle;
  const Vector3d local(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                       std::cos(azimuth) * std::cos(elevation));
  return {.origin = view.sensor.position, .direction = (view.sensor.orientation * local).normalized()};
}

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
