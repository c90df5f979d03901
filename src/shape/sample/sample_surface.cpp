#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"
#include "core/geometry/subset.hpp"
#include "shape/sample/surface_sampler.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_noise_stream = 0x73796e7468'03;

/// Limit of batches a round while the required number is unknown. The first round has one; later rounds double.
constexpr std::size_t k_most_blind_batches = 16;
/// The same afterwards; bounds the memory.
constexpr std::size_t k_most_round_batches = 256;
/// Batches that measure the area for a density. If none of them hits, there is no surface.
constexpr std::size_t k_measuring_batches = 64;

/// The size of the next round. The final result does not depend on it.
std::size_t next_round(std::size_t batches_done, std::size_t points, std::size_t wanted) {
  if (points == 0 || wanted == 0) return std::min(batches_done + 1, k_most_blind_batches);
  const double batches_a_point = static_cast<double>(batches_done) / static_cast<double>(points);
  const double batches = std::ceil(static_cast<double>(wanted - points) * batches_a_point);
  return batches < static_cast<double>(k_most_round_batches) ? static_cast<std::size_t>(batches) : k_most_round_batches;
}

/// Draws as many points as requested: all of the first batches and a random part of the last.
PointCloud draw_points(const SurfaceSampler& sampler, const SampleOptions& options, const RunContext& run) {
  PointCloud cloud;
  std::size_t wanted = options.density > 0.0 ? 0 : options.count;
  std::size_t batches_done = 0;
  for (;;) {
    if (batches_done >= k_measuring_batches) {
      if (cloud.size() == 0) refuse_without_surface();
      if (wanted == 0) {
        const auto candidates = static_cast<double>(batches_done * SurfaceSampler::k_batch_candidates);
        const double area = sampler.area() * static_cast<double>(cloud.size()) / candidates;
        wanted = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(options.density * area)));
      }
    }
    if (wanted > 0 && cloud.size() >= wanted) break;
    const std::size_t round = next_round(batches_done, cloud.size(), wanted);
    for (const PointCloud& batch : sampler.batches(batches_done, round, run)) {
      append(cloud, batch);
    }
    batches_done += round;
    run.report("sample", std::min(cloud.size(), wanted), wanted, "points");
  }
  cloud.positions.resize(wanted);
  cloud.normals.resize(wanted);
  return cloud;
}

/// Rotates a normal by an angle about a random orthogonal axis.
Vector3d tilt(const Vector3d& normal, double angle, RandomStream& random) {
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vector3d first = normal.unitOrthogonal();
  const Vector3d across = std::cos(direction) * first + std::sin(direction) * normal.cross(first);
  return (std::cos(angle) * normal + std::sin(angle) * across).normalized();
}

void add_noise(PointCloud& cloud, const SampleOptions& options) {
  const double tilt_sigma = options.normal_noise_deg * std::numbers::pi / 180.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(options.seed, k_noise_stream, i);
    const Vector3d shift{random.normal(), random.normal(), random.normal()};  // braces: in this order
    cloud.positions.set(i, cloud.positions[i] + options.noise * shift);
    if (tilt_sigma > 0.0) cloud.normals.set(i, tilt(cloud.normals[i], tilt_sigma * random.normal(), random));
  }
}

}  // namespace

std::optional<OptionConflict> conflict_in(const SampleOptions& options) {
  if (options.count > 0 || options.density > 0) return std::nullopt;
  return OptionConflict{"count", "expected at least one point"};
}

PointCloud sample_surface(const Model& model, const SampleOptions& options, const RunContext& run) {
  validate(options);
  const SurfaceSampler sampler(model, options.seed, run);
  PointCloud cloud = draw_points(sampler, options, run);
  if (options.noise > 0.0 || options.normal_noise_deg > 0.0) add_noise(cloud, options);
  return cloud;
}

}  // namespace cloud2csg
