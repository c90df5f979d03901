#include "core/fields/point_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloud2csg/advanced/restrict.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

/// Measures a tree at points, one block of neighbours at a time. Far primitives do not matter: where the tree without
/// all primitives farther than r has a value below r, the whole tree has the same value.
class FitMeasure {
 public:
  FitMeasure(const Model& model, const PointCloud& cloud, double noise, const PointFitOptions& options,
             const RunContext& run)
      : tree_(tree_of(model)),
        restriction_(tree_),
        primitives_(model.primitives),
        cloud_(cloud),
        run_(run),
        order_(options.order) {
    fit_.values.resize(cloud.size());
    fit_.signed_distances.resize(cloud.size());
    if (cloud.has_normals()) fit_.angles.resize(cloud.size());
    if (options.with_owners) fit_.owners.assign(cloud.size(), k_no_owner);
    tie_ = options.tie * bounds_of(cloud.positions).diagonal().norm();
    const std::vector<PrimitiveIndex> used = primitives_of(tree_);
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
    for_each_index((cloud_.size() + k_block - 1) / k_block, run_, [&](std::size_t block) {
      const std::size_t begin = block * k_block;
      measure_block(begin, std::min(k_block, cloud_.size() - begin));
    });
    return std::move(fit_);
  }

 private:
  static constexpr std::size_t k_block = 1024;
  static constexpr std::size_t k_few_primitives = 4;  // up to this many are evaluated everywhere
  static constexpr double k_first_radius = 4;         // multiple of the noise
  static constexpr double k_growth = 8;

  /// The tree's primitives and the boxes in which each is nearer than `radius`.
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

  /// Returns the points for which the level's radius is too small.
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
                         [&](std::uint32_t i) { return !(std::abs(fit_.values[i]) < level.radius); });
    return left;
  }

  void measure_with(const CsgTree& tree, const std::vector<std::uint32_t>& points) {
    const Points positions = select_points(cloud_.positions, points);
    const std::vector<double> values = implicit_value(tree, primitives_, positions);
    for (std::size_t k = 0; k < points.size(); ++k) {
      fit_.values[points[k]] = fit_.signed_distances[points[k]] = values[k];
    }
    if (!fit_.angles.empty()) measure_gradients(tree, points, positions);
    if (!fit_.owners.empty()) {
      const std::vector<PrimitiveIndex> owners = owners_of(values, tree, primitives_, positions, tie_);
      for (std::size_t k = 0; k < points.size(); ++k) fit_.owners[points[k]] = owners[k];
    }
  }

  void measure_gradients(const CsgTree& tree, const std::vector<std::uint32_t>& points, PointsView positions) {
    const Points gradients = implicit_gradient(tree, primitives_, positions);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double length = gradients[k].norm();
      const double cosine = length > 0 ? gradients[k].dot(cloud_.normals[points[k]]) / length : 0.0;
      if (length > 0) fit_.signed_distances[points[k]] /= length;
      fit_.angles[points[k]] = std::acos(std::clamp(cosine, -1.0, 1.0));
    }
  }

  const CsgTree& tree_;
  TreeRestriction restriction_;
  const PrimitiveSet& primitives_;
  const PointCloud& cloud_;
  const RunContext& run_;
  std::span<const std::uint32_t> order_;
  double tie_ = 0;             // values that differ by less count as equal
  std::vector<Level> levels_;  // by radius; empty when the whole tree is evaluated everywhere
  PointFit fit_;
};

}  // namespace

std::vector<PrimitiveIndex> owners_of(std::span<const double> values, const CsgTree& tree,
                                      const PrimitiveSet& primitives, PointsView points, double tolerance) {
  std::vector<PrimitiveIndex> owners(points.size(), k_no_owner);
  for (const PrimitiveIndex p : primitives_of(tree)) {
    const std::vector<double> distances = signed_distance(primitives[p], points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      // min, max and negation are exact: the tree's value is that of one of its primitives, bit for bit.
      const double difference = std::abs(std::abs(distances[i]) - std::abs(values[i]));
      if (owners[i] == k_no_owner && difference <= tolerance) owners[i] = p;
    }
  }
  return owners;
}

PointFit measure_points(const Model& model, const PointCloud& cloud, double noise, const PointFitOptions& options,
                        const RunContext& run) {
  return FitMeasure(model, cloud, noise, options, run).measure();
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double quantile_95(std::vector<double>& values) {
  const auto at_95 = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 95 / 100);
  std::nth_element(values.begin(), at_95, values.end());
  return *at_95;
}

}  // namespace cloud2csg
