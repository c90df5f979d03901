#include "pipeline/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cloud2csg/error.hpp"
#include "core/geometry/place_text.hpp"
#include "paper/merge/merge_component.hpp"
#include "pipeline/bare_surface.hpp"
#include "pipeline/unused_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_much_unexplained = 0.1;
constexpr double k_coarse = 0.05;  ///< tolerance, of the diagonal
constexpr double k_much_disagreement = 0.1;
constexpr double k_much_bare_surface = 0.05;
constexpr std::size_t k_noted_surface = 200;  ///< points of the cloud for one of a surface that is worth a word
constexpr double k_bare_spacings = 6;         ///< as far from all points, a surface is bare

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

/// Where most of the points lie that are on no surface, and on nothing that is known.
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
  constexpr double k_neighbourhood = 0.1;  // of the diagonal
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
        "more than a tenth of the points is on no primitive: primitives may be missing or badly fitted");
  } else if (statistics.fit.p95_distance > tolerance) {
    warnings.push_back(
        fmt::format("more than a twentieth of the points is farther than {:.3g} from the surface of the result: "
                    "primitives may be missing or badly fitted",
                    tolerance));
  }
  if (!statistics.cells && statistics.merge.worst_shortfall > k_tolerated_shortfall) {
    warnings.push_back(
        fmt::format("the trees of the partitions did not merge well: on one of the primitives, {:.0f} % of what its "
                    "partition explains is lost",
                    100 * statistics.merge.worst_shortfall));
  }
  if (!statistics.complete) warnings.emplace_back("stopped early: this is the best tree so far");
  return warnings;
}

std::vector<std::string> tolerance_warnings(double tolerance, double diagonal) {
  if (tolerance >= diagonal) {
    throw invalid_option("detection.distance_tolerance",
                         fmt::format("{:.3g} is as large as the cloud, whose diagonal is {:.3g}", tolerance, diagonal),
                         "give it in the cloud's units, or leave it out: it is taken from the noise");
  }
  if (tolerance <= k_coarse * diagonal) return {};
  return {fmt::format("the tolerance, {:.3g}, is {:.2g} % of the cloud's diagonal: smaller parts are lost", tolerance,
                      100 * tolerance / diagonal)};
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
      fmt::format("{:.0f} % of the points lie on no surface that was found, most of them near {}: a larger "
                  "tolerance than {:.3g} may help, or these parts are of free form",
                  100 * unexplained, place_text(unexplained_place(found, prepared), prepared.scale.diagonal),
                  detection.distance_tolerance)};
}

std::vector<std::string> disagreement_warnings(const CsgTree& tree, const FoundPrimitives& found, double disagreement) {
  if (disagreement <= k_much_disagreement) return {};
  const Eigen::Vector3d worst = worst_place(tree, found.choice.solids, found.choice.places);
  return {
      fmt::format("the tree is doubtful: it is wrong at places that weigh {:.0f} % of the solid's volume and "
                  "surface, worst near {}",
                  100 * disagreement, place_text(worst, found.prepared.scale.diagonal))};
}

std::vector<std::string> bare_surface_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                               const RunContext& run) {
  const double near = std::max(k_bare_spacings * found.prepared.scale.spacing, 2 * found.detection.distance_tolerance);
  const auto bare = find_bare_surface(tree, found.choice.solids, found.prepared.cloud, near, run);
  if (!bare || bare->share < k_much_bare_surface) return {};
  return {
      fmt::format("{:.0f} % of the result's surface has no points near it, least of all at {}: what is there "
                  "is a guess",
                  100 * bare->share, place_text(bare->middle, found.prepared.scale.diagonal))};
}

std::vector<std::string> unused_surface_warnings(const CsgTree& tree, const FoundPrimitives& found) {
  const PointCloud& cloud = found.prepared.cloud;
  const UnusedSurfaces unused =
      find_unused_surfaces(tree, found.choice.solids, cloud, found.detection.surfaces,
                           2 * found.detection.distance_tolerance, cloud.size() / k_noted_surface);
  if (unused.count == 0) return {};
  const DetectedSurface& largest = found.detection.surfaces[unused.largest];
  const Eigen::Vector3d middle = bounds_of(select_points(cloud, largest.points).positions).center();
  return {
      fmt::format("of the surfaces that were found, {} are not on the result, the largest a {} of {} "
                  "points near {}",
                  unused.count, type_name(largest.surface.type), largest.points.size(),
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
    warnings.push_back(fmt::format("the points do not bear out the known primitive {}: {} of {} lie on it", name,
                                   found.points[p].points.size(), found.prepared.cloud.size()));
  }
  return warnings;
}

}  // namespace cloud2csg
