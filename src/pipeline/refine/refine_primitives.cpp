#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "cloud2csg/advanced/refine.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/tree/taken.hpp"
#include "pipeline/refine/regularities.hpp"
#include "pipeline/refine/solve.hpp"
#include "raw/surface/robust_loss.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_least_points = 12;  // to refine a primitive
constexpr double k_owner_sigmas = 4.0;      // largest distance of a point from its primitive
constexpr double k_noise_floor = 1e-7;      // share of the cloud's diagonal
constexpr double k_settled = 0.01;          // relative change of the noise
constexpr double k_contradiction = 10.0;    // allowed loss per saved unknown, in squares of the noise
constexpr double k_slack = 1e-3;            // allowed loss per point, in squares of the noise
constexpr double k_radians_per_degree = std::numbers::pi / 180.0;
constexpr std::size_t k_least_sample = 20'000;

/// Evenly thinned points for the refinement.
PointCloud sample_of(const PointCloud& cloud, std::size_t most) {
  const std::size_t count = std::min(cloud.size(), most);
  PointCloud sample;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * cloud.size() / count;
    sample.positions.push_back(cloud.positions[from]);
    sample.normals.push_back(cloud.normals[from]);
  }
  return sample;
}

struct Ownership {
  OwnedPoints points;
  std::vector<double> distances;  ///< unsigned, of all points before thinning
};

class Refiner {
 public:
  Refiner(const PointCloud& cloud, const PrimitiveSet& given, const CsgTree& tree, const RefineOptions& options,
          const RunContext& run)
      : sample_(sample_of(cloud, std::max(k_least_sample, options.most_points * given.size()))),
        given_(given),
        tree_(tree),
        options_(options),
        run_(run),
        floor_(k_noise_floor * bounds_of(sample_.positions).diagonal().norm()) {}

  Refinement refine() {
    PrimitiveSet primitives = given_;
    double noise =
        std::max(options_.noise.value_or(estimate_noise(sample_, given_, options_.angle_tolerance_deg, run_)), floor_);
    for (int round = 0; round < options_.rounds; ++round) {
      run_.throw_if_stopped();
      const Ownership owned = owned_points(primitives, noise);
      const double measured = noise_of(owned, noise);
      // One by one: without shared unknowns the solution is many times faster.
      Arrangement arrangement = separate(primitives, origins_of(owned.points));
      primitives = solved_apart(arrangement, primitives, owned.points, measured);
      result_.rounds = round + 1;
      run_.report("refine", static_cast<std::size_t>(round) + 1, static_cast<std::size_t>(options_.rounds) + 1);
      const bool is_settled = std::abs(measured - noise) <= k_settled * noise;
      noise = measured;
      if (is_settled && round > 0) break;
    }
    if (options_.regularise) primitives = regular(primitives, noise);
    run_.report("refine", static_cast<std::size_t>(options_.rounds) + 1, static_cast<std::size_t>(options_.rounds) + 1);
    return judged(primitives, noise);
  }

 private:
  [[nodiscard]] Ownership owned_points(const PrimitiveSet& primitives, double noise) const {
    const double least_cosine = std::cos(options_.angle_tolerance_deg * k_radians_per_degree);
    const std::vector<Taken> taken = taken_by_primitive(tree_, primitives, sample_.positions);
    Ownership owned{.points = OwnedPoints(primitives.size()), .distances = {}};
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      Points positions;
      for (const std::size_t i : taken[p].points) positions.push_back(sample_.positions[i]);
      const std::vector<double> distances = signed_distance(primitives[p], positions);
      const Points slopes = gradient(primitives[p], positions);
      Points near;
      for (std::size_t k = 0; k < positions.size(); ++k) {
        if (std::abs(distances[k]) > k_owner_sigmas * noise) continue;
        const double along = taken[p].signs[k] * slopes[k].dot(sample_.normals[taken[p].points[k]]);
        if (along < least_cosine * slopes[k].norm()) continue;
        near.push_back(positions[k]);
        owned.distances.push_back(std::abs(distances[k]));
      }
      owned.points[p] = some_of(near);
    }
    return owned;
  }

  [[nodiscard]] Points some_of(const Points& points) const {
    if (points.size() < k_least_points) return {};
    if (points.size() <= options_.most_points) return points;
    Points some;
    for (std::size_t i = 0; i < options_.most_points; ++i) {
      some.push_back(points[i * points.size() / options_.most_points]);
    }
    return some;
  }

  [[nodiscard]] double noise_of(const Ownership& owned, double before) const {
    if (options_.noise) return std::max(*options_.noise, floor_);
    std::vector<double> distances = owned.distances;
    return distances.empty() ? before : std::max(robust_deviation(distances), floor_);
  }

  [[nodiscard]] static std::vector<std::optional<Eigen::Vector3d>> origins_of(const OwnedPoints& points) {
    std::vector<std::optional<Eigen::Vector3d>> origins(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (points[p].empty()) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < points[p].size(); ++i) sum += points[p][i] - points[p][0];
      origins[p] = points[p][0] + sum / static_cast<double>(points[p].size());
    }
    return origins;
  }

  /// Solves each member by itself, in parallel.
  [[nodiscard]] PrimitiveSet solved_apart(const Arrangement& arrangement, const PrimitiveSet& primitives,
                                          const OwnedPoints& points, double noise) const {
    PrimitiveSet result = primitives;
    for_each_index(arrangement.members.size(), run_, [&](std::size_t m) {
      const PrimitiveIndex p = arrangement.members[m].primitive;
      std::vector<std::optional<Eigen::Vector3d>> origin(primitives.size());
      origin[p] = arrangement.frames[arrangement.members[m].frame].origin;
      Arrangement alone = separate(primitives, origin);
      solve(alone, primitives, points, noise);
      result[p] = arranged(alone, primitives)[p];
    });
    return result;
  }

  [[nodiscard]] PrimitiveSet regular(const PrimitiveSet& primitives, double noise) {
    const Ownership owned = owned_points(primitives, noise);
    const Arrangement apart = separate(primitives, origins_of(owned.points));
    std::vector<MemberUncertainty> uncertainties(apart.members.size());
    for_each_index(apart.members.size(), run_, [&](std::size_t m) {
      const PrimitiveIndex p = apart.members[m].primitive;
      uncertainties[m] = uncertainty_of(apart, apart.members[m], primitives[p], owned.points[p], noise);
    });
    // First all regularities; directions only if the points contradict.
    for (const bool with_values : {true, false}) {
      run_.throw_if_stopped();
      RegularArrangement regular = regularised(
          apart, primitives, given_, uncertainties, owned.points,
          {.angle = options_.regularity_angle_deg * k_radians_per_degree, .value = noise, .with_values = with_values});
      if (regular.regularities.empty()) return primitives;
      solve(regular.arrangement, primitives, owned.points, noise);
      PrimitiveSet result = arranged(regular.arrangement, primitives);
      const double allowed = loss_of(primitives, owned.points, noise) +
                             k_contradiction * static_cast<double>(regular.unknowns_saved) +
                             k_slack * static_cast<double>(owned.distances.size());
      if (loss_of(result, owned.points, noise) > allowed) continue;
      result_.regularities = std::move(regular.regularities);
      return result;
    }
    return primitives;
  }

  /// In squares of the noise.
  [[nodiscard]] static double loss_of(const PrimitiveSet& primitives, const OwnedPoints& points, double noise) {
    double sum = 0;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (points[p].empty()) continue;
      for (const double distance : signed_distance(primitives[p], points[p])) {
        const double value = RobustLoss{}(distance / noise).value;
        sum += value * value;
      }
    }
    return sum;
  }

  [[nodiscard]] double loss_of_tree(const PrimitiveSet& primitives, double noise) const {
    double sum = 0;
    for (const double distance : implicit_value(tree_, primitives, sample_.positions)) {
      const double value = RobustLoss{}(distance / noise).value;
      sum += value * value;
    }
    return sum;
  }

  [[nodiscard]] static bool are_valid(const PrimitiveSet& primitives) {
    try {
      for (const Primitive& primitive : primitives) validate(primitive);
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  [[nodiscard]] Refinement judged(const PrimitiveSet& primitives, double noise) {
    result_.noise = noise;
    result_.changes.resize(given_.size());
    const OwnedPoints points = owned_points(primitives, noise).points;
    result_.is_better = are_valid(primitives) && loss_of_tree(primitives, noise) < loss_of_tree(given_, noise);
    result_.primitives = result_.is_better ? primitives : given_;
    if (!result_.is_better) result_.regularities.clear();
    double squares_before = 0;
    double squares_after = 0;
    for (std::size_t p = 0; p < given_.size(); ++p) {
      PrimitiveChange& change = result_.changes[p];
      change.points = points[p].size();
      if (points[p].empty()) continue;
      change.rms_before = rms_of(given_[p], points[p]);
      change.rms_after = rms_of(result_.primitives[p], points[p]);
      describe_move(given_[p], result_.primitives[p], change);
      const auto count = static_cast<double>(points[p].size());
      squares_before += count * change.rms_before * change.rms_before;
      squares_after += count * change.rms_after * change.rms_after;
      result_.points += points[p].size();
    }
    const double count = std::max(1.0, static_cast<double>(result_.points));
    result_.rms_before = std::sqrt(squares_before / count);
    result_.rms_after = std::sqrt(squares_after / count);
    return std::move(result_);
  }

  /// The points belong to the refined primitive, so there are hardly any outliers among them.
  [[nodiscard]] static double rms_of(const Primitive& primitive, const Points& points) {
    double squares = 0;
    for (const double distance : signed_distance(primitive, points)) squares += distance * distance;
    return std::sqrt(squares / static_cast<double>(points.size()));
  }

  static void describe_move(const Primitive& before, const Primitive& after, PrimitiveChange& change) {
    const Eigen::Quaterniond& from = before.pose.orientation;
    const Eigen::Quaterniond& to = after.pose.orientation;
    double turn = from.angularDistance(to);
    if (is_turned_around_axis(before)) {
      const Eigen::Vector3d a = from * Eigen::Vector3d::UnitZ();
      const Eigen::Vector3d b = to * Eigen::Vector3d::UnitZ();
      turn = std::atan2(a.cross(b).norm(), a.dot(b));
    }
    change.turn_deg = turn / k_radians_per_degree;
    // Relative to the old position, along the primitive's own axes.
    const LocalFrame frame{.orientation = from, .origin = before.pose.position};
    const std::vector<Slot> was = slots_of(before, frame);
    const std::vector<Slot> is = slots_of(after, frame);
    for (std::size_t k = 0; k < was.size(); ++k) {
      change.largest_shift = std::max(change.largest_shift, std::abs(is[k].value - was[k].value));
    }
  }

  PointCloud sample_;
  const PrimitiveSet& given_;
  const CsgTree& tree_;
  RefineOptions options_;
  const RunContext& run_;
  double floor_;
  Refinement result_;
};

}  // namespace

Refinement refine_primitives(const PointCloud& cloud, const PrimitiveSet& primitives, const CsgTree& tree,
                             const RefineOptions& options, const RunContext& run) {
  assert(cloud.has_normals() && cloud.size() > 0);
  validate(options);
  return Refiner(cloud, primitives, tree, options, run).refine();
}

}  // namespace cloud2csg
