#include "pipeline/verdict.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/cubes.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/place_text.hpp"
#include "core/geometry/subset.hpp"
#include "pipeline/coverage.hpp"
#include "pipeline/diagnostics.hpp"
#include "raw/solids/bare_surface.hpp"

namespace cloud2csg {
namespace {

constexpr double k_least_within = 0.95;     ///< share of the points near a good result
constexpr double k_much_unexplained = 0.1;  ///< share of the points that contradict a doubtful result
constexpr double k_too_much_unexplained = 0.5;
constexpr double k_much_disagreement = 0.1;
constexpr double k_too_much_disagreement = 1;  ///< that of the empty solid
constexpr double k_much_bare_surface = 0.05;

struct Doubt {
  Grade grade;
  std::string text;
};

/// Never rounded up, so that 100 % means all.
std::string percent(double share) {
  return fmt::format("{} %", std::floor(1000 * share) / 10);
}

Verdict with_doubts(Verdict verdict, std::vector<Doubt> doubts) {
  for (Doubt& doubt : doubts) {
    verdict.grade = std::max(verdict.grade, doubt.grade);
    verdict.doubts.push_back(std::move(doubt.text));
  }
  return verdict;
}

/// Edge of the cubes that make regions: a fiftieth of the diagonal, a feature that a person would look for. In a sparse
/// cloud it is twice the spacing of as many points spread over a square with the side of this diagonal.
double region_edge(double diagonal, std::size_t points) {
  return std::max(diagonal / 50, 2 * diagonal / std::sqrt(static_cast<double>(points)));
}

/// As few as detection needs for a surface. Noise alone seldom puts as many side by side.
constexpr std::size_t k_least_in_region = 12;

/// The entries of a list at these places.
template <typename Entry>
std::vector<Entry> entries(const std::vector<Entry>& list, std::span<const std::uint32_t> places) {
  std::vector<Entry> chosen;
  chosen.reserve(places.size());
  for (const std::uint32_t i : places) chosen.push_back(list[i]);
  return chosen;
}

UnexplainedRegion region_of(const Points& points, std::span<const std::uint32_t> own) {
  const AlignedBox box = bounds_of(select_points(points, own));
  return {.points = own.size(), .place = box.center(), .size = box.diagonal().norm()};
}

/// Positions in `far` whose cubes hold at least as many of these points as of others.
std::vector<std::uint32_t> crowded(const Points& points, std::span<const std::uint64_t> cubes_of_far, double edge) {
  struct Counts {
    std::size_t far = 0, all = 0;
  };
  std::unordered_map<std::uint64_t, Counts> counts;
  for (const std::uint64_t cube : cubes_of_far) ++counts[cube].far;
  const Eigen::Vector3d corner = bounds_of(points).min();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = counts.find(cube_of(points[i] - corner, edge));
    if (found != counts.end()) ++found->second.all;
  }
  std::vector<std::uint32_t> kept;
  for (std::uint32_t k = 0; k < cubes_of_far.size(); ++k) {
    const Counts& here = counts[cubes_of_far[k]];
    if (2 * here.far >= here.all) kept.push_back(k);
  }
  return kept;
}

std::vector<Doubt> doubts_of_fit(const Verdict& verdict) {
  const double unexplained = share(verdict.unexplained_points, verdict.points);
  if (unexplained > k_much_unexplained) {
    return {{unexplained > k_too_much_unexplained ? Grade::failed : Grade::doubtful,
             percent(unexplained) + " of the points contradict it, by place or normal"}};
  }
  if (verdict.share_within >= k_least_within) return {};
  return {{Grade::doubtful, percent(k_least_within) + " are expected"}};
}

std::vector<Doubt> doubts_of_tolerance(double tolerance, double diagonal) {
  if (!is_coarse(tolerance, diagonal)) return {};
  return {{Grade::doubtful, fmt::format("that distance is {} of the cloud's diagonal, so it says little",
                                        percent(tolerance / diagonal))}};
}

/// The corners of a box far around the points: a bounded solid contains none of them.
std::vector<Doubt> doubts_of_bounds(const Model& model, const AlignedBox& around) {
  constexpr double k_diagonals = 1e4;
  const double far = k_diagonals * around.diagonal().norm();
  Points corners;
  for (const double x : {-far, far}) {
    for (const double y : {-far, far}) {
      for (const double z : {-far, far}) corners.push_back(around.center() + Eigen::Vector3d(x, y, z));
    }
  }
  const std::vector<double> values = implicit_value(*model.tree, model.primitives, corners);
  if (std::ranges::none_of(values, [](double value) { return value < 0; })) return {};
  return {{Grade::doubtful, "the solid is unbounded: normals may lead inward"}};
}

std::vector<Doubt> doubts_of_disagreement(const Extraction& result, const LabelledPlaces& places,
                                          const Eigen::Vector3d& origin) {
  const FindingStatistics& finding = *result.statistics.finding;
  if (finding.disagreement <= k_much_disagreement) return {};
  const Eigen::Vector3d worst = worst_place(result.tree(), result.model.primitives, places);
  return {{finding.disagreement >= k_too_much_disagreement ? Grade::failed : Grade::doubtful,
           fmt::format("the points contradict {} of its volume and surface, worst near {}",
                       percent(finding.disagreement), place_text(origin + worst, finding.diagonal))}};
}

/// The surface that no point of the cloud is near: closed where an added one is, and bare elsewhere.
struct UnseenSurface {
  double closed = 0, bare = 0;  ///< shares of the solid's surface
  // Of each, the place farthest from all points of the cloud.
  Eigen::Vector3d closed_place = Eigen::Vector3d::Zero();
  Eigen::Vector3d bare_place = Eigen::Vector3d::Zero();
};

UnseenSurface unseen_surface(const BareSurface& surface, const Points& added, double near) {
  UnseenSurface unseen;
  double farthest_closed = 0, farthest_bare = 0;
  const NeighbourTree index(added);
  for (std::size_t i = 0; i < surface.shares.size(); ++i) {
    const Eigen::Vector3d place = surface.samples.positions[i];
    const bool is_closed = added.size() > 0 && index.nearest(place).distance <= near;
    (is_closed ? unseen.closed : unseen.bare) += surface.shares[i];
    double& farthest = is_closed ? farthest_closed : farthest_bare;
    if (surface.distances[i] <= farthest) continue;
    farthest = surface.distances[i];
    (is_closed ? unseen.closed_place : unseen.bare_place) = place;
  }
  return unseen;
}

std::vector<Doubt> doubts_of_unseen_surface(const UnseenSurface& unseen, const Eigen::Vector3d& origin,
                                            double diagonal) {
  std::vector<Doubt> doubts;
  if (unseen.bare > k_much_bare_surface) {
    doubts.push_back(
        {Grade::doubtful, fmt::format("{} of its surface has no points nearby, farthest from any at {}",
                                      percent(unseen.bare), place_text(origin + unseen.bare_place, diagonal))});
  }
  if (unseen.closed > k_much_bare_surface) {
    doubts.push_back(
        {Grade::doubtful, fmt::format("nobody saw {} of its surface, which was closed, farthest from any point at {}",
                                      percent(unseen.closed), place_text(origin + unseen.closed_place, diagonal))});
  }
  return doubts;
}

std::vector<Doubt> doubts_of_unused_surfaces(const Extraction& result, const Eigen::Vector3d& origin) {
  const UnusedSurfaces unused = find_unused_surfaces(result);
  if (unused.count == 0) return {};
  const DetectedSurface& largest = result.surfaces[unused.largest];
  const Eigen::Vector3d middle = bounds_of(select_points(result.cloud.positions, largest.points)).center();
  return {{Grade::doubtful,
           fmt::format("{} of the detected surfaces {} not on it, the largest a {} of {} points near {}", unused.count,
                       unused.count == 1 ? "is" : "are", type_name(largest.surface.type), largest.points.size(),
                       place_text(origin + middle, result.statistics.finding->diagonal))}};
}

}  // namespace

std::string to_text(const Verdict& verdict) {
  std::vector<std::string> clauses;
  if (verdict.distance > 0) {
    clauses.push_back(
        fmt::format("{} of the points within {:.3g} of the surface", percent(verdict.share_within), verdict.distance));
  }
  clauses.insert(clauses.end(), verdict.doubts.begin(), verdict.doubts.end());
  return fmt::format("{}: {}", to_string(verdict.grade), fmt::join(clauses, "; "));
}

std::vector<std::string> region_lines(const Verdict& verdict) {
  constexpr double k_diagonals = 10;  // gives the place to a thousandth of the region's size
  std::vector<std::string> lines;
  for (const UnexplainedRegion& region : verdict.regions) {
    lines.push_back(fmt::format("unexplained: {} points around {}, {:.3g} across", region.points,
                                place_text(region.place, k_diagonals * region.size), region.size));
  }
  return lines;
}

std::vector<UnexplainedRegion> unexplained_regions(const Points& points, const std::vector<std::uint32_t>& far) {
  if (far.size() < k_least_in_region) return {};
  const AlignedBox box = bounds_of(points);
  const double edge = region_edge(box.diagonal().norm(), points.size());
  if (!(edge > 0)) return {{.points = far.size(), .place = box.center(), .size = 0}};
  std::vector<std::uint64_t> cubes;
  cubes.reserve(far.size());
  for (const std::uint32_t i : far) cubes.push_back(cube_of(points[i] - box.min(), edge));
  const std::vector<std::uint32_t> kept = crowded(points, cubes, edge);
  std::vector<UnexplainedRegion> regions;
  for (const std::vector<std::uint32_t>& group : connected_groups(entries(cubes, kept))) {
    if (group.size() < k_least_in_region) break;
    regions.push_back(region_of(points, entries(far, entries(kept, group))));
  }
  return regions;
}

Verdict judge_fit(const Model& model, const FitStatistics& fit, const Points& points) {
  const CsgTree& tree = *model.tree;
  if (is_constant(tree)) {
    const bool is_empty = tree == CsgTree::empty();
    return with_doubts(
        {.points = points.size(), .unexplained_points = points.size()},
        {{Grade::failed, is_empty ? "the result is empty: no formula over the primitives explains the points"
                                  : "the result is all of space: normals may lead inward"}});
  }
  const Verdict verdict{.distance = fit.tolerances.distance,
                        .points = points.size(),
                        .share_within = share(points.size() - fit.far_points.size(), points.size()),
                        .unexplained_points = fit.unexplained_points,
                        .regions = unexplained_regions(points, fit.far_points)};
  return with_doubts(with_doubts(verdict, doubts_of_fit(verdict)), doubts_of_bounds(model, bounds_of(points)));
}

Extraction judged(Extraction result, const Points& added, const LabelledPlaces& places, const Eigen::Vector3d& origin,
                  const RunContext& run) {
  FindingStatistics& finding = *result.statistics.finding;
  finding.disagreement = wrong_place_share(result.tree(), result.model.primitives, places);
  const double near = bare_distance(finding.spacing, finding.tolerance);
  const UnseenSurface unseen = unseen_surface(
      find_bare_surface(result.tree(), result.model.primitives, result.cloud.positions, near, run), added, near);
  Verdict verdict = judge_fit(result.model, result.statistics.fit, result.cloud.positions);
  verdict.disagreement = finding.disagreement;
  verdict.bare_surface = unseen.bare;
  verdict.closed_surface = unseen.closed;
  std::vector<Doubt> coarse = doubts_of_tolerance(verdict.distance, finding.diagonal);
  verdict = with_doubts(std::move(verdict), std::move(coarse));
  verdict = with_doubts(std::move(verdict), doubts_of_disagreement(result, places, origin));
  verdict = with_doubts(std::move(verdict), doubts_of_unseen_surface(unseen, origin, finding.diagonal));
  result.statistics.verdict = with_doubts(std::move(verdict), doubts_of_unused_surfaces(result, origin));
  return result;
}

Verdict judge_detection(const FoundPrimitives& found) {
  const Points& points = found.prepared.cloud.positions;
  const std::size_t unexplained = found.unexplained.size();
  const double tolerance = found.detection.distance_tolerance;
  std::vector<Doubt> doubts = doubts_of_tolerance(tolerance, found.prepared.scale.diagonal);
  if (share(unexplained, points.size()) > k_much_unexplained) {
    doubts.push_back(
        {Grade::doubtful, percent(share(unexplained, points.size())) + " of the points lie on no detected surface"});
  }
  if (found.no_solid) doubts.push_back({Grade::doubtful, "the surfaces bound no solid"});
  return with_doubts({.distance = tolerance,
                      .points = points.size(),
                      .share_within = share(points.size() - unexplained, points.size()),
                      .unexplained_points = unexplained,
                      .regions = unexplained_regions(points, found.unexplained)},
                     std::move(doubts));
}

}  // namespace cloud2csg
