#include "pipeline/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parallel.hpp"
#include "cloud2csg/restrict.hpp"
#include "fitness/spatial_order.hpp"

namespace cloud2csg {
namespace {

struct PointFit {
  std::vector<double> distances;  // unsigned
  std::vector<double> angles;     // radians
};

/// Measures a tree at points, a block of neighbours at a time. Far from a primitive a tree is as without it: where the
/// tree without all primitives farther than r has a value below r, the whole tree has the same.
class FitMeasure {
 public:
  FitMeasure(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud, double noise,
             const RunContext& run, std::span<const std::uint32_t> order)
      : tree_(tree), restriction_(tree), primitives_(primitives), cloud_(cloud), run_(run), order_(order) {
    const std::vector<PrimitiveIndex> used = primitives_of(tree);
    if (used.size() > k_few_primitives) {
      const double diagonal = bounds_of(cloud.positions).diagonal().norm();
      double radius = std::max(k_first_radius * noise, 1e-9 * diagonal);
      while (radius < diagonal) {
        levels_.push_back(level_of(used, radius));
        radius *= k_growth;
      }
    }
  }

  PointFit measure() {
    fit_.distances.resize(cloud_.size());
    fit_.angles.resize(cloud_.size());
    for_each_index((cloud_.size() + k_block - 1) / k_block, run_, [&](std::size_t block) {
      const std::size_t begin = block * k_block;
      measure_block(begin, std::min(k_block, cloud_.size() - begin));
    });
    return std::move(fit_);
  }

 private:
  static constexpr std::size_t k_block = 1024;
  static constexpr std::size_t k_few_primitives = 4;  // are evaluated everywhere
  static constexpr double k_first_radius = 4;         // of the noise
  static constexpr double k_growth = 8;

  /// All primitives of the tree, and where they are nearer than a radius.
  struct Level {
    double radius;
    std::vector<PrimitiveIndex> primitives;
    std::vector<AlignedBox> reach;
  };

  [[nodiscard]] Level level_of(const std::vector<PrimitiveIndex>& used, double radius) const {
    Level level{.radius = radius, .primitives = used, .reach = {}};
    for (const PrimitiveIndex p : used) level.reach.push_back(reach(primitives_[p], radius));
    return level;
  }

  void measure_block(std::size_t begin, std::size_t count) {
    std::vector<std::uint32_t> points(count);
    if (order_.empty()) {
      std::iota(points.begin(), points.end(), static_cast<std::uint32_t>(begin));
    } else {
      std::ranges::copy(order_.subspan(begin, count), points.begin());
    }
    for (const Level& level : levels_) {
      points = measure_near(level, points);
      if (points.empty()) return;
    }
    measure_with(tree_, points);
  }

  /// Returns the points that the level's radius is too small for.
  std::vector<std::uint32_t> measure_near(const Level& level, const std::vector<std::uint32_t>& points) {
    AlignedBox box;
    for (const std::uint32_t i : points) box.extend(cloud_.positions[i]);
    std::vector<PrimitiveIndex> near;
    for (std::size_t k = 0; k < level.primitives.size(); ++k) {
      if (level.reach[k].intersects(box)) near.push_back(level.primitives[k]);
    }
    measure_with(restriction_.restrict_to(near), points);
    std::vector<std::uint32_t> left;
    std::ranges::copy_if(points, std::back_inserter(left),
                         [&](std::uint32_t i) { return !(fit_.distances[i] < level.radius); });
    return left;
  }

  void measure_with(const CsgTree& tree, const std::vector<std::uint32_t>& points) {
    Points positions;
    for (const std::uint32_t i : points) positions.push_back(cloud_.positions[i]);
    const std::vector<double> values = implicit_value(tree, primitives_, positions);
    const Points gradients = implicit_gradient(tree, primitives_, positions);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double length = gradients[k].norm();
      const double cosine = length > 0 ? gradients[k].dot(cloud_.normals[points[k]]) / length : 0.0;
      fit_.distances[points[k]] = std::abs(values[k]);
      fit_.angles[points[k]] = std::acos(std::clamp(cosine, -1.0, 1.0));
    }
  }

  const CsgTree& tree_;
  TreeRestriction restriction_;
  const PrimitiveSet& primitives_;
  const PointCloud& cloud_;
  const RunContext& run_;
  std::span<const std::uint32_t> order_;
  std::vector<Level> levels_;  // by radius; none where the whole tree is evaluated everywhere
  PointFit fit_;
};

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// What 95 % are below. Reorders them.
double quantile_95(std::vector<double>& values) {
  const auto at_95 = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 95 / 100);
  std::nth_element(values.begin(), at_95, values.end());
  return *at_95;
}

}  // namespace

std::vector<std::uint32_t> unexplained_points(const CsgTree& tree, const PrimitiveSet& primitives,
                                              const PointCloud& cloud, const SegmentationTolerances& tolerances,
                                              const RunContext& run) {
  const std::vector<std::uint32_t> order = spatial_order(cloud.positions, bounds_of(cloud.positions), run);
  const PointFit points = FitMeasure(tree, primitives, cloud, tolerances.distance, run, order).measure();
  const double largest_angle = std::acos(tolerances.cosine);
  std::vector<std::uint32_t> unexplained;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!(points.distances[i] <= tolerances.distance) || !(points.angles[i] <= largest_angle)) unexplained.push_back(i);
  }
  return unexplained;
}

FitStatistics measure_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                          const Objective& objective, double noise, const RunContext& run,
                          std::span<const std::uint32_t> order) {
  PointFit points = FitMeasure(tree, primitives, cloud, noise, run, order).measure();
  FitStatistics fit;
  fit.objective = -objective.alpha * static_cast<double>(tree.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    fit.objective += point_score(points.distances[i], points.angles[i], objective);
  }
  fit.rms_distance = root_mean_square(points.distances);
  fit.rms_angle_deg = root_mean_square(points.angles) * 180.0 / std::numbers::pi;
  fit.p95_distance = quantile_95(points.distances);
  fit.p95_angle_deg = quantile_95(points.angles) * 180.0 / std::numbers::pi;
  return fit;
}

}  // namespace cloud2csg
