#include "raw/detect/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/subset.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

/// Products of the errors of two points, and the squares of their distances, in a ring of neighbours.
struct Ring {
  double products = 0, squares = 0, count = 0;

  [[nodiscard]] double covariance() const { return products / count; }
  [[nodiscard]] double square() const { return squares / count; }
};

const std::size_t k_ring_points = k_nearest / 2;
using Rings = std::array<Ring, 4>;

/// Surfaces near a point, and whether smoothing has mixed them there.
class Edges {
 public:
  Edges(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, double length)
      : surfaces_(surfaces), cloud_(cloud), positions_(cloud.positions()), tree_(positions_), length_(length) {
    owners_.assign(cloud.size(), k_no_surface);
    for (std::uint32_t k = 0; k < surfaces.size(); ++k) own(surfaces[k].points, k);
  }

  /// Whether two of the first `end` surfaces pass near the point, at an angle.
  [[nodiscard]] bool is_at(std::uint32_t point, std::uint32_t end) const {
    // Half of it leaves strips along edges, double drops faces between two edges.
    constexpr double k_reach = 1.25;
    std::vector<Eigen::Vector3d> normals;
    for (const std::uint32_t k : around(point, end)) {
      if (distance(point, k) >= k_reach * length_) continue;
      const Eigen::Vector3d here = normal(surfaces_[k].surface, positions_[point]);
      const auto is_across = [&](const Eigen::Vector3d& one) { return std::abs(one.dot(here)) < k_alike_cosine; };
      if (std::ranges::any_of(normals, is_across)) return true;
      normals.push_back(here);
    }
    return false;
  }

  /// Whether the point is on one of the first `end` surfaces, whatever its normal.
  [[nodiscard]] bool is_on_any(std::uint32_t point, std::uint32_t end) const {
    const double precision = cloud_.points[point].precision;
    return std::ranges::any_of(around(point, end),
                               [&](std::uint32_t k) { return distance(point, k) * precision <= surfaces_[k].reach; });
  }

  void forget(std::uint32_t surface) { own(surfaces_[surface].points, k_no_surface); }

 private:
  static constexpr std::uint32_t k_no_surface = std::numeric_limits<std::uint32_t>::max();

  void own(const std::vector<std::uint32_t>& points, std::uint32_t surface) {
    for (const std::uint32_t i : points) owners_[i] = surface;
  }
  [[nodiscard]] double distance(std::uint32_t point, std::uint32_t surface) const {
    return std::abs(signed_distance(surfaces_[surface].surface, positions_[point]));
  }
  /// Those of the first `end` surfaces that have points not far from this one.
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t point, std::uint32_t end) const {
    // Points of a surface that passes within 1.25 lengths. Half of it misses those beyond a strip of the edge, double
    // takes four times as long.
    constexpr double k_far = 3;
    std::vector<std::uint32_t> found;
    for (const std::uint32_t other : tree_.within(positions_[point], k_far * length_)) {
      const std::uint32_t owner = owners_[other];
      if (owner < end && std::ranges::find(found, owner) == found.end()) found.push_back(owner);
    }
    return found;
  }

  const std::vector<GrownSurface>& surfaces_;
  const WorkCloud& cloud_;
  Points positions_;
  NeighbourTree tree_;
  double length_;
  std::vector<std::uint32_t> owners_;  ///< by point
};

/// The points with is_wanted(point). @throws Cancelled
template <class IsWanted>
std::vector<std::uint32_t> those(std::span<const std::uint32_t> points, const RunContext& run,
                                 const IsWanted& is_wanted) {
  std::vector<std::uint8_t> wanted(points.size(), 0);
  for_each_index(points.size(), run, [&](std::size_t i) { wanted[i] = is_wanted(points[i]) ? 1 : 0; });
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (wanted[i] == 1) found.push_back(points[i]);
  }
  return found;
}

/// Null if there is none.
const GrownSurface* largest_plane(const std::vector<GrownSurface>& surfaces) {
  const GrownSurface* largest = nullptr;
  for (const GrownSurface& s : surfaces) {
    if (s.surface.type != SurfaceType::plane) continue;
    if (largest == nullptr || s.points.size() > largest->points.size()) largest = &s;
  }
  return largest;
}

/// Limits errors to three of their deviations: strips of neighbouring faces are no errors.
std::vector<double> clamped(std::vector<double> errors) {
  std::vector<double> absolute(errors.size());
  std::ranges::transform(errors, absolute.begin(), [](double error) { return std::abs(error); });
  const double most = k_deviations * robust_deviation(absolute);
  for (double& error : errors) error = std::clamp(error, -most, most);
  return errors;
}

/// Rings of neighbours around a sample of the plane's points, the nearest first. Neighbours by the distance along the
/// plane: those in space have similar errors, whatever the errors are.
Rings rings_on(const GrownSurface& plane, const WorkCloud& cloud, std::span<const double> errors) {
  Points feet = cloud.positions_of(plane.points);
  const Eigen::Vector3d& normal = plane.surface.axis;
  for (std::size_t k = 0; k < feet.size(); ++k) {
    feet.set(k, feet[k] - (feet[k] - plane.surface.position).dot(normal) * normal);
  }
  const NeighbourTree tree(feet);
  Rings rings;
  std::vector<std::uint32_t> near(rings.size() * k_ring_points + 1);
  std::vector<double> squares(near.size());
  for (std::size_t sample = 0; sample < k_sample; ++sample) {
    const std::size_t k = sample * feet.size() / k_sample;
    tree.find(feet[k], near, squares);
    for (std::size_t n = 1; n < near.size(); ++n) {  // after the point itself
      Ring& ring = rings[(n - 1) / k_ring_points];
      ring.products += errors[k] * errors[near[n]];
      ring.squares += squares[n];
      ring.count += 1;
    }
  }
  return rings;
}

/// A Gaussian of the distance.
struct Correlation {
  double covariance;  ///< at no distance
  double square;      ///< of the distance at which 1/e is left
};

/// The Gaussian through the first and the last ring, if the others are on it: errors that copies of a point or the
/// lines of a scanner share are not.
std::optional<Correlation> gaussian_through(const Rings& rings) {
  const Ring& first = rings.front();
  const Ring& last = rings.back();
  if (!(first.covariance() > last.covariance() && last.covariance() > 0)) return std::nullopt;
  const double square = (last.square() - first.square()) / std::log(first.covariance() / last.covariance());
  const Correlation gaussian{.covariance = first.covariance() * std::exp(first.square() / square), .square = square};
  const auto is_on = [&](const Ring& ring) {
    const double ratio = ring.covariance() / (gaussian.covariance * std::exp(-ring.square() / square));
    return ratio >= k_clear_share && ratio * k_clear_share <= 1;
  };
  return std::ranges::all_of(rings, is_on) ? std::optional(gaussian) : std::nullopt;
}

}  // namespace

double smoothing_length(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, double noise) {
  // The rings reach over two spacings. They do not tell a longer distance from a form error.
  constexpr double k_most_spacings = 3;
  constexpr double k_least_noise = 0.5;  // of what detection assumes, which is more than the rounding of exact clouds
  const GrownSurface* plane = largest_plane(surfaces);
  if (plane == nullptr || plane->points.size() < k_sample) return 0;
  const std::vector<double> errors = clamped(distances_of(plane->surface, cloud, plane->points));
  double variance = 0;
  for (const double error : errors) variance += error * error / static_cast<double>(errors.size());
  const Rings rings = rings_on(*plane, cloud, errors);
  const std::optional<Correlation> gaussian = gaussian_through(rings);
  // Rounding of an exact cloud is no noise.
  if (!gaussian || std::sqrt(variance) <= k_least_noise * noise) return 0;
  // The nearest points are within a disc of as many squared spacings.
  const double spacing = std::sqrt(2 * rings.front().square() * std::numbers::pi / static_cast<double>(k_ring_points));
  const double length = std::sqrt(gaussian->square);
  // Smoothing leaves hardly any error that is not shared with the neighbours.
  return gaussian->covariance > k_clear_share * variance && length < k_most_spacings * spacing ? length : 0;
}

std::vector<GrownSurface> without_smoothed_edges(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                                 double length, const SearchLimits& limits, const RunContext& run) {
  std::ranges::stable_sort(surfaces, std::ranges::greater{}, [](const GrownSurface& s) { return s.points.size(); });
  Edges edges(surfaces, cloud, length);
  const auto is_edge = [&](std::uint32_t k) {
    // A sample shows that most surfaces are no edges.
    const std::vector<std::uint32_t> sample = some_of(surfaces[k].points, k_sample);
    const auto is_at = [&](std::uint32_t i) { return edges.is_at(i, k); };
    if (2 * those(sample, run, is_at).size() < sample.size()) return false;
    const std::vector<std::uint32_t> own =
        those(surfaces[k].points, run, [&](std::uint32_t i) { return !edges.is_at(i, k) && !edges.is_on_any(i, k); });
    return own.empty() || connected_groups(cloud.points, own, limits.link).front().size() < limits.least_points;
  };
  std::vector<GrownSurface> kept;
  for (auto k = static_cast<std::uint32_t>(surfaces.size()); k-- > 0;) {
    if (is_edge(k)) {
      edges.forget(k);
    } else {
      kept.push_back(std::move(surfaces[k]));
    }
  }
  std::ranges::reverse(kept);
  return kept;
}

std::vector<std::uint32_t> points_at_edges(std::span<const std::uint32_t> points,
                                           const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           double length, const RunContext& run) {
  const Edges edges(surfaces, cloud, length);
  const auto all = static_cast<std::uint32_t>(surfaces.size());
  return those(points, run, [&](std::uint32_t i) { return edges.is_at(i, all); });
}

}  // namespace cloud2csg
