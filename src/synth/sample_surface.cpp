#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/sample.hpp"
#include "synth/primitive_surface.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

enum class Stream : std::uint64_t { candidates = 0x73796e7468'01, order = 0x73796e7468'02, noise = 0x73796e7468'03 };

constexpr std::size_t k_batch_candidates = 4096;
/// Batches between two looks at whether there are enough points: at first one, then twice as many each time up to
/// this. Never by the number of threads, which must not change the result.
constexpr std::size_t k_most_round_batches = 16;
/// Batches that measure the area for a wanted density; as many without a hit mean that there is no surface.
constexpr std::size_t k_measuring_batches = 64;

[[noreturn]] void fail_option(std::string name, std::string expected) {
  throw Error({.file = {}, .where = std::move(name), .expected = std::move(expected), .remedy = {}});
}

void check_options(const SampleOptions& options) {
  const auto is_valid = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!is_valid(options.density)) fail_option("density", "expected a finite number that is not negative");
  if (!is_valid(options.noise)) fail_option("noise", "expected a finite number that is not negative");
  if (!is_valid(options.normal_noise_deg)) fail_option("normal_noise_deg", "expected a finite angle, not negative");
  if (options.count == 0 && options.density == 0.0) fail_option("count", "expected at least one point");
}

[[noreturn]] void fail_without_surface() {
  throw Error({.file = {}, .where = "tree", .expected = "the solid is empty: it has no surface", .remedy = {}});
}

AlignedBox finite_bounds(const CsgTree& tree, const PrimitiveSet& primitives) {
  const AlignedBox region = bounds_of(tree, primitives);
  if (region.isEmpty()) fail_without_surface();
  if (!region.min().allFinite() || !region.max().allFinite()) {
    throw Error({.file = {},
                 .where = "tree",
                 .expected = "the solid is unbounded: its surface cannot be sampled",
                 .remedy = "intersect it with a bounded primitive such as a box"});
  }
  return region;
}

/// One side of `epsilon` to the other through each point, along its normal.
Points offset(const PointCloud& candidates, double epsilon) {
  Points moved(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    moved.set(i, candidates.positions[i] + epsilon * candidates.normals[i]);
  }
  return moved;
}

/// Shuffles, for the points of a batch come primitive by primitive and a part of it must be like the whole.
void shuffle(PointCloud& cloud, RandomStream random) {
  for (std::size_t i = cloud.size(); i > 1; --i) {
    const std::size_t j = random.below(i);
    for (Points* points : {&cloud.positions, &cloud.normals}) {
      std::swap(points->x[i - 1], points->x[j]);
      std::swap(points->y[i - 1], points->y[j]);
      std::swap(points->z[i - 1], points->z[j]);
    }
  }
}

/// Draws candidates from the primitives' own surfaces and keeps those on the surface of the whole solid.
class SurfaceSampler {
 public:
  SurfaceSampler(const CsgTree& tree, const PrimitiveSet& primitives, std::uint64_t seed, const RunContext& run)
      : tree_(tree), primitives_(primitives), used_(primitives_of(tree)), seed_(seed) {
    const AlignedBox region = finite_bounds(tree, primitives);
    // Far above the rounding of coordinates, far below any detail.
    constexpr double k_relative_epsilon = 1e-6;
    epsilon_ = k_relative_epsilon * region.diagonal().norm();
    for (const PrimitiveIndex p : used_) {
      surfaces_.push_back(make_surface(primitives[p], region, run));
      area_ += surfaces_.back().area;
      cumulative_area_.push_back(area_);
    }
    if (!(area_ > 0.0)) fail_without_surface();
  }

  /// Of all primitives' own surfaces, hidden or not.
  [[nodiscard]] double area() const { return area_; }

  /// The visible ones of the candidates of a batch. The same for the same batch, always.
  [[nodiscard]] PointCloud batch(std::uint64_t index) const {
    const Candidates candidates = draw(index);
    const PointCloud& points = candidates.points;
    const std::vector<double> outer = implicit_value(tree_, primitives_, offset(points, epsilon_));
    const std::vector<double> inner = implicit_value(tree_, primitives_, offset(points, -epsilon_));
    Candidates visible;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((outer[i] < 0.0) == (inner[i] < 0.0)) continue;
      const double side = inner[i] < 0.0 ? 1.0 : -1.0;  // the solid is outside of a primitive that is cut away
      visible.add(points.positions[i], side * points.normals[i], candidates.owners[i]);
    }
    PointCloud unique = without_duplicates(visible);
    shuffle(unique, RandomStream(seed_, static_cast<std::uint64_t>(Stream::order), index));
    return unique;
  }

 private:
  struct Candidates {
    PointCloud points;
    std::vector<PrimitiveIndex> owners;

    void add(const Vector3d& position, const Vector3d& normal, PrimitiveIndex owner) {
      points.positions.push_back(position);
      points.normals.push_back(normal);
      owners.push_back(owner);
    }
  };

  [[nodiscard]] Candidates draw(std::uint64_t batch_index) const {
    RandomStream random(seed_, static_cast<std::uint64_t>(Stream::candidates), batch_index);
    std::vector<PointCloud> by_surface(surfaces_.size());
    for (std::size_t i = 0; i < k_batch_candidates; ++i) {
      const auto found = std::ranges::upper_bound(cumulative_area_, random.uniform() * area_);
      const auto last = static_cast<std::ptrdiff_t>(used_.size()) - 1;
      const auto chosen = static_cast<std::size_t>(std::min(found - cumulative_area_.begin(), last));
      if (surfaces_[chosen].area == 0.0) continue;
      const SurfacePoint point = surfaces_[chosen].draw(random);
      by_surface[chosen].positions.push_back(point.position);
      by_surface[chosen].normals.push_back(point.normal);
    }
    Candidates candidates;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
      PointCloud& points = by_surface[s];
      const std::vector<bool> is_good =
          surfaces_[s].settle ? surfaces_[s].settle(points) : std::vector<bool>(points.size(), true);
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_good[i]) candidates.add(points.positions[i], points.normals[i], used_[s]);
      }
    }
    return candidates;
  }

  /// Where surfaces of several primitives coincide, only the points of the one with the smallest index stay.
  [[nodiscard]] PointCloud without_duplicates(const Candidates& candidates) const {
    const PointCloud& points = candidates.points;
    std::vector<bool> is_duplicate(points.size(), false);
    for (const PrimitiveIndex p : used_) {
      const std::vector<double> distances = signed_distance(primitives_[p], points.positions);
      std::vector<std::size_t> suspects;
      Points places;
      for (std::size_t i = 0; i < points.size(); ++i) {
        // A displacement or an expression may be steep: the exact test divides by the slope.
        constexpr double k_steepest = 100.0;
        if (p >= candidates.owners[i] || std::abs(distances[i]) > k_steepest * epsilon_) continue;
        suspects.push_back(i);
        places.push_back(points.positions[i]);
      }
      const Points gradients = gradient(primitives_[p], places);
      for (std::size_t k = 0; k < suspects.size(); ++k) {
        const std::size_t i = suspects[k];
        const double slope = gradients[k].norm();
        constexpr double k_parallel = 1e-4;  // of the sine between the normals
        if (slope > 0.0 && std::abs(distances[i]) <= epsilon_ * slope &&
            gradients[k].cross(points.normals[i]).norm() <= k_parallel * slope) {
          is_duplicate[i] = true;
        }
      }
    }
    PointCloud unique;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (is_duplicate[i]) continue;
      unique.positions.push_back(points.positions[i]);
      unique.normals.push_back(points.normals[i]);
    }
    return unique;
  }

  const CsgTree& tree_;
  const PrimitiveSet& primitives_;
  std::vector<PrimitiveIndex> used_;
  std::vector<PrimitiveSurface> surfaces_;
  std::vector<double> cumulative_area_;
  double area_ = 0.0;
  double epsilon_ = 0.0;
  std::uint64_t seed_;
};

void append(Points& points, const Points& more) {
  points.x.insert(points.x.end(), more.x.begin(), more.x.end());
  points.y.insert(points.y.end(), more.y.begin(), more.y.end());
  points.z.insert(points.z.end(), more.z.begin(), more.z.end());
}

/// As many points as the options want: all of the first batches and a random part of the last.
PointCloud draw_points(const SurfaceSampler& sampler, const SampleOptions& options, const RunContext& run) {
  PointCloud cloud;
  std::size_t wanted = options.density > 0.0 ? 0 : options.count;
  std::size_t batches_done = 0;
  for (std::size_t round_batches = 1;; round_batches = std::min(2 * round_batches, k_most_round_batches)) {
    if (batches_done >= k_measuring_batches) {
      if (cloud.size() == 0) fail_without_surface();
      if (wanted == 0) {
        const auto candidates = static_cast<double>(batches_done * k_batch_candidates);
        const double area = sampler.area() * static_cast<double>(cloud.size()) / candidates;
        wanted = std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(options.density * area)));
      }
    }
    if (wanted > 0 && cloud.size() >= wanted) break;
    std::vector<PointCloud> batches(round_batches);
    for_each_index(round_batches, run, [&](std::size_t i) { batches[i] = sampler.batch(batches_done + i); });
    batches_done += round_batches;
    for (const PointCloud& batch : batches) {
      append(cloud.positions, batch.positions);
      append(cloud.normals, batch.normals);
    }
    run.report("sample", std::min(cloud.size(), wanted), wanted);
  }
  cloud.positions.resize(wanted);
  cloud.normals.resize(wanted);
  return cloud;
}

/// The normal turned by an angle around a random axis across it.
Vector3d tilt(const Vector3d& normal, double angle, RandomStream& random) {
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const Vector3d first = normal.unitOrthogonal();
  const Vector3d across = std::cos(direction) * first + std::sin(direction) * normal.cross(first);
  return (std::cos(angle) * normal + std::sin(angle) * across).normalized();
}

void add_noise(PointCloud& cloud, const SampleOptions& options) {
  const double tilt_sigma = options.normal_noise_deg * std::numbers::pi / 180.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(options.seed, static_cast<std::uint64_t>(Stream::noise), i);
    const Vector3d shift{random.normal(), random.normal(), random.normal()};  // braces: in this order
    cloud.positions.set(i, cloud.positions[i] + options.noise * shift);
    if (tilt_sigma > 0.0) cloud.normals.set(i, tilt(cloud.normals[i], tilt_sigma * random.normal(), random));
  }
}

}  // namespace

PointCloud sample_surface(const CsgTree& tree, const PrimitiveSet& primitives, const SampleOptions& options,
                          const RunContext& run) {
  check_options(options);
  const SurfaceSampler sampler(tree, primitives, options.seed, run);
  PointCloud cloud = draw_points(sampler, options, run);
  if (options.noise > 0.0 || options.normal_noise_deg > 0.0) add_noise(cloud, options);
  return cloud;
}

}  // namespace cloud2csg
