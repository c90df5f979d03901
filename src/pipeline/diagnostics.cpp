#include "pipeline/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "core/geometry/place_text.hpp"
#include "paper/merge/merge_component.hpp"

namespace cloud2csg {
namespace {

constexpr double k_many_outliers = 0.01;
constexpr double k_much_doubt = 0.01;
constexpr double k_coarse = 0.05;  ///< tolerance as a share of the diagonal

}  // namespace

bool is_coarse(double tolerance, double diagonal) {
  return tolerance > k_coarse * diagonal;
}

double share(std::size_t part, std::size_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

std::size_t count_of(std::span<const SurfacePoints> primitives) {
  std::size_t count = 0;
  for (const SurfacePoints& own : primitives) count += own.points.size();
  return count;
}

std::vector<std::string> search_warnings(const ExtractStatistics& statistics) {
  std::vector<std::string> warnings;
  if (!statistics.cells && statistics.merge.worst_shortfall > k_tolerated_shortfall) {
    warnings.push_back(
        fmt::format("the trees of the partitions did not merge well: one primitive lost {:.0f} % of the fit that its "
                    "partition reached",
                    100 * statistics.merge.worst_shortfall));
  }
  if (!statistics.complete) warnings.emplace_back("stopped early: this is the best tree so far");
  return warnings;
}

std::vector<std::string> tolerance_warnings(double tolerance, const Scale& scale) {
  const double diagonal = scale.diagonal;
  if (tolerance >= diagonal) {
    throw invalid_option("detection.distance_tolerance",
                         fmt::format("{:.3g} is as large as the cloud, whose diagonal is {:.3g}", tolerance, diagonal),
                         "give it in the cloud's units, or leave it out to use a multiple of the noise");
  }
  if (is_coarse(tolerance, diagonal)) {
    return {fmt::format("the tolerance, {:.3g}, is {:.2g} % of the cloud's diagonal: smaller parts are lost", tolerance,
                        100 * tolerance / diagonal)};
  }
  if (tolerance >= scale.noise) return {};
  return {
      fmt::format("the tolerance, {:.3g}, is less than the noise of the points, about {:.3g}: many are left over, or "
                  "surfaces fall to pieces",
                  tolerance, scale.noise)};
}

std::vector<std::string> normals_warnings(const PreparedCloud& prepared, const Eigen::Vector3d& origin) {
  if (prepared.doubtful_normals <= k_much_doubt) return {};
  return {fmt::format(
      "The orientation of the normals is doubtful for {:.3g} % of the points, near {}: give sensor "
      "positions or normals if you have them.",
      100 * prepared.doubtful_normals, place_text(origin + prepared.doubtful_place, prepared.scale.diagonal))};
}

std::vector<std::string> outlier_warnings(const CleanReport& report, std::size_t points) {
  std::vector<std::string> warnings;
  const std::size_t outliers = report.isolated + report.off_surface;
  if (share(outliers, points) > k_many_outliers) {
    warnings.push_back(fmt::format("{} of {} points are outliers and are left out", outliers, points));
  }
  if (report.smoothed > 0) {
    warnings.push_back(
        fmt::format("the cloud was smoothed, which rounds edges: {} of {} points beside edges are left out, and the "
                    "edges are sharp",
                    report.smoothed, points));
  }
  return warnings;
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
