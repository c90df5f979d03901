#include "pipeline/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cells/surface_samples.hpp"
#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/place_text.hpp"
#include "paper/merge/merge_component.hpp"

namespace cloud2csg {
namespace {

/// The part of a solid's surface that no point of a cloud is near.
struct BareSurface {
  double share = 0;                                  ///< share of the solid's surface within the bounds of the cloud
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< the place on it farthest from all points
};

using Eigen::Vector3d;

constexpr std::size_t k_samples = 400;  ///< per primitive
constexpr double k_step = 1e-4;  ///< share of the diagonal: distance of the two test points on either side of a surface

/// The samples that lie on the solid's surface.
Points on_surface(const PointCloud& samples, const CsgTree& tree, const PrimitiveSet& primitives, double step) {
  Points over;
  Points under;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    over.push_back(samples.positions[i] + step * samples.normals[i]);
    under.push_back(samples.positions[i] - step * samples.normals[i]);
  }
  const std::vector<double> above = implicit_value(tree, primitives, over);
  const std::vector<double> below = implicit_value(tree, primitives, under);
  Points result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if ((above[i] < 0) != (below[i] < 0)) result.push_back(samples.positions[i]);
  }
  return result;
}

/// Estimated from deterministic samples; absent without samples on the surface. O(points log points + samples x size)
std::optional<BareSurface> find_bare_surface(const CsgTree& tree, const PrimitiveSet& primitives,
                                             const PointCloud& cloud, double near, const RunContext& run) {
  const AlignedBox box = bounds_of(cloud.positions);
  const NeighbourTree points(cloud.positions);
  BareSurface result;
  double all = 0;
  double bare = 0;
  double farthest = near;
  for (const PrimitiveIndex p : primitives_of(tree)) {
    run.throw_if_stopped();
    const AlignedBox reached = reach(primitives[p], 0);
    const SurfaceSamples samples =
        sample_surfaces({primitives[p]}, std::span(&reached, 1), box, {.base = k_samples, .a_neighbour = 0}, run);
    const Points places = on_surface(samples.points, tree, primitives, k_step * box.diagonal().norm());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance = points.nearest(places[i]).distance;
      all += samples.area_of_sample[0];
      if (distance <= near) continue;
      bare += samples.area_of_sample[0];
      if (distance <= farthest) continue;
      farthest = distance;
      result.middle = places[i];
    }
  }
  if (!(all > 0)) return std::nullopt;
  result.share = bare / all;
  return result;
}

/// Detected surfaces whose points are not on the solid.
struct UnusedSurfaces {
  std::size_t count = 0;
  std::size_t largest = 0;  ///< index of the surface with the most points; meaningless for count 0
};

constexpr std::size_t k_sample = 200;  // points that represent a surface

bool is_unused(const CsgTree& tree, const PrimitiveSet& solids, const PointCloud& cloud, const DetectedSurface& surface,
               double near) {
  const std::size_t count = std::min(k_sample, surface.points.size());
  Points places;
  for (std::size_t k = 0; k < count; ++k) {
    places.push_back(cloud.positions[surface.points[k * surface.points.size() / count]]);
  }
  const std::vector<double> values = implicit_value(tree, solids, places);
  const auto far = std::ranges::count_if(values, [near](double value) { return std::abs(value) > near; });
  return 2 * static_cast<std::size_t>(far) > count;
}

/// A surface is unused when more than half of its points are farther than `near` from the solid's surface. Skips
/// surfaces with fewer than `least_points` points. O(surfaces x size)
UnusedSurfaces find_unused_surfaces(const CsgTree& tree, const PrimitiveSet& solids, const PointCloud& cloud,
                                    std::span<const DetectedSurface> surfaces, double near, std::size_t least_points) {
  UnusedSurfaces unused;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].points.size() < least_points || !is_unused(tree, solids, cloud, surfaces[s], near)) continue;
    if (unused.count == 0 || surfaces[s].points.size() > surfaces[unused.largest].points.size()) unused.largest = s;
    ++unused.count;
  }
  return unused;
}

constexpr double k_many_outliers = 0.01;
constexpr double k_much_unexplained = 0.1;
constexpr double k_coarse = 0.05;  ///< tolerance as a share of the diagonal
constexpr double k_much_disagreement = 0.1;
constexpr double k_much_bare_surface = 0.05;
constexpr double k_noted_surface = 0.005;  ///< no warning for surfaces with a smaller share of the points
constexpr double k_bare_spacings = 6;      ///< a surface this many spacings from all points is bare

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// The centre of most points that lie on no surface and no known primitive.
Eigen::Vector3d unexplained_place(const RestDetection& found, const PreparedCloud& prepared) {
  std::vector<bool> is_explained(prepared.cloud.size(), false);
  const auto note = [&is_explained](std::span<const std::uint32_t> points) {
    for (const std::uint32_t i : points) is_explained[i] = true;
  };
  for (const DetectedSurface& surface : found.detection.surfaces) note(surface.points);
  for (const SurfacePoints& known : found.known) note(known.points);
  Points rest;
  for (std::size_t i = 0; i < is_explained.size(); ++i) {
    if (!is_explained[i]) rest.push_back(prepared.cloud.positions[i]);
  }
  constexpr double k_neighbourhood = 0.1;  // share of the diagonal
  return crowded_place(rest, k_neighbourhood * prepared.scale.diagonal);
}

}  // namespace

std::size_t count_of(std::span<const SurfacePoints> primitives) {
  std::size_t count = 0;
  for (const SurfacePoints& own : primitives) count += own.points.size();
  return count;
}

std::vector<std::string> fit_warnings(const ExtractStatistics& statistics, double tolerance) {
  std::vector<std::string> warnings;
  if (10 * statistics.unassigned_points > statistics.points) {
    warnings.emplace_back(
        "more than a tenth of the points are on no primitive: primitives may be missing or badly fitted");
  } else if (statistics.fit.p95_distance > tolerance) {
    warnings.push_back(
        fmt::format("more than a twentieth of the points are farther than {:.3g} from the surface of the result: "
                    "primitives may be missing or badly fitted",
                    tolerance));
  }
  if (!statistics.cells && statistics.merge.worst_shortfall > k_tolerated_shortfall) {
    warnings.push_back(
        fmt::format("the trees of the partitions did not merge well: one primitive lost {:.0f} % of the fit that its "
                    "partition reached",
                    100 * statistics.merge.worst_shortfall));
  }
  if (!statistics.complete) warnings.emplace_back("stopped early: this is the best tree so far");
  return warnings;
}

std::vector<std::string> tolerance_warnings(double tolerance, double diagonal) {
  if (tolerance >= diagonal) {
    throw invalid_option("detection.distance_tolerance",
                         fmt::format("{:.3g} is as large as the cloud, whose diagonal is {:.3g}", tolerance, diagonal),
                         "give it in the cloud's units, or leave it out to use a multiple of the noise");
  }
  if (tolerance <= k_coarse * diagonal) return {};
  return {fmt::format("the tolerance, {:.3g}, is {:.2g} % of the cloud's diagonal: smaller parts are lost", tolerance,
                      100 * tolerance / diagonal)};
}

std::vector<std::string> outlier_warnings(const CleanReport& report, std::size_t points) {
  const std::size_t outliers = report.isolated + report.off_surface;
  if (share(outliers, points) <= k_many_outliers) return {};
  return {fmt::format("{} of {} points are outliers and are left out", outliers, points)};
}

std::vector<std::string> detection_warnings(const RestDetection& found, const PreparedCloud& prepared) {
  const PointCloud& cloud = prepared.cloud;
  const Detection& detection = found.detection;
  if (detection.surfaces.empty() && count_of(found.known) == 0) {
    throw Error(
        {.expected = fmt::format("no plane, sphere, cylinder, cone or torus explains enough of the {} points "
                                 "within {:.3g}",
                                 cloud.size(), detection.distance_tolerance),
         .remedy = "give a larger `detection.distance_tolerance`, or a cloud of an object made of such surfaces"});
  }
  const double unexplained = share(detection.unexplained, cloud.size());
  if (unexplained <= k_much_unexplained) return {};
  return {
      fmt::format("{:.0f} % of the points lie on no detected surface, most of them near {}: a larger tolerance than "
                  "{:.3g} may help, or these parts are of free form",
                  100 * unexplained, place_text(unexplained_place(found, prepared), prepared.scale.diagonal),
                  detection.distance_tolerance)};
}

std::vector<std::string> disagreement_warnings(const CsgTree& tree, const FoundPrimitives& found, double disagreement) {
  if (disagreement <= k_much_disagreement) return {};
  const Eigen::Vector3d worst = worst_place(tree, found.choice.solids, found.choice.places);
  return {fmt::format(
      "the tree is doubtful: it contradicts the points in {:.0f} % of the solid's volume and surface, worst near {}",
      100 * disagreement, place_text(worst, found.prepared.scale.diagonal))};
}

std::vector<std::string> bare_surface_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                               const RunContext& run) {
  const double near = std::max(k_bare_spacings * found.prepared.scale.spacing, 2 * found.detection.distance_tolerance);
  const auto bare = find_bare_surface(tree, found.choice.solids, found.prepared.cloud, near, run);
  if (!bare || bare->share < k_much_bare_surface) return {};
  return {fmt::format(
      "{:.0f} % of the result's surface has no points nearby, farthest from any at {}: the solid there is a guess",
      100 * bare->share, place_text(bare->middle, found.prepared.scale.diagonal))};
}

std::vector<std::string> unused_surface_warnings(const CsgTree& tree, const FoundPrimitives& found) {
  const PointCloud& cloud = found.prepared.cloud;
  const auto least_points = static_cast<std::size_t>(k_noted_surface * static_cast<double>(cloud.size()));
  const UnusedSurfaces unused = find_unused_surfaces(tree, found.choice.solids, cloud, found.detection.surfaces,
                                                     2 * found.detection.distance_tolerance, least_points);
  if (unused.count == 0) return {};
  const DetectedSurface& largest = found.detection.surfaces[unused.largest];
  const Eigen::Vector3d middle = bounds_of(select_points(cloud, largest.points).positions).center();
  return {fmt::format("{} detected surfaces are not on the result, the largest a {} of {} points near {}", unused.count,
                      type_name(largest.surface.type), largest.points.size(),
                      place_text(middle, found.prepared.scale.diagonal))};
}

std::vector<std::string> unused_known_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                               const PrimitiveSet& known, std::span<const std::string> told) {
  std::vector<std::string> warnings;
  const std::vector<PrimitiveIndex> used = primitives_of(tree);
  for (PrimitiveIndex p = 0; p < known.size(); ++p) {
    const std::string name = fmt::format("'{}'", known[p].id);
    const auto names_it = [&name](const std::string& text) { return text.find(name) != std::string::npos; };
    if (std::ranges::find(used, p) != used.end() || std::ranges::any_of(told, names_it)) continue;
    warnings.push_back(fmt::format("the points do not support the known primitive {}: {} of {} lie on it", name,
                                   found.points[p].points.size(), found.prepared.cloud.size()));
  }
  return warnings;
}

}  // namespace cloud2csg
