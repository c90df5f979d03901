#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "cloud2csg/advanced/prepare.hpp"
#include "core/base/run.hpp"
#include "core/geometry/subset.hpp"
#include "raw/prepare/orientation.hpp"
#include "raw/prepare/outliers.hpp"

namespace cloud2csg {
namespace {

/// Relative to the diagonal: more noise hides typical details of a part.
constexpr double k_much_noise = 0.01;

void warn_of_noise(PreparedCloud& prepared) {
  if (prepared.scale.noise > k_much_noise * prepared.scale.diagonal) {
    prepared.warnings.push_back(
        fmt::format("The noise is {:.2g} % of the cloud's diagonal: details below {:.3g} are lost.",
                    100.0 * prepared.scale.noise / prepared.scale.diagonal, 6.0 * prepared.scale.noise));
  }
}

void turn(Points& normals) {
  for (std::vector<double>* axis : {&normals.x, &normals.y, &normals.z}) {
    for (double& value : *axis) value = -value;
  }
}

/// Keeps the given normals if those of the sure points are good, and returns whether they are.
bool keep_given_normals(PreparedCloud& prepared, const PointCloud& sure, const RunContext& run) {
  switch (check_normals(sure, prepared.scale, run)) {
    case NormalsVerdict::outward:
      return true;
    case NormalsVerdict::inward:
      turn(prepared.cloud.normals);
      prepared.warnings.emplace_back("The normals pointed into the solid and were turned.");
      return true;
    case NormalsVerdict::unoriented:
      prepared.warnings.emplace_back("The normals contradicted the surface or each other and were estimated again.");
      return false;
  }
  return false;
}

/// `doubted`: points that may yet be left out, so that their normals do not count.
void note_normals(PreparedCloud& prepared, const PointCloud& cloud, const EstimatedNormals& estimated,
                  std::span<const std::uint32_t> doubted) {
  prepared.normals_estimated = true;
  std::vector<std::uint32_t> doubtful;
  std::set_difference(estimated.doubtful.begin(), estimated.doubtful.end(), doubted.begin(), doubted.end(),
                      std::back_inserter(doubtful));
  if (doubtful.empty()) return;
  prepared.doubtful_normals = static_cast<double>(doubtful.size()) / static_cast<double>(cloud.size() - doubted.size());
  prepared.doubtful_place = cloud.positions[doubtful[doubtful.size() / 2]];
}

/// Whether removing so many points changes the rest noticeably.
bool is_much(std::size_t left_out, std::size_t points) {
  return static_cast<double>(left_out) >= k_settled * static_cast<double>(points);
}

bool has_duplicates(const LocalFits& fits) {
  for (std::size_t i = 0; i < fits.points.size(); ++i) {
    const std::span<const float> distances = fits.neighbours.distances_of(i);
    if (!distances.empty() && distances.front() == 0.0F) return true;
  }
  return false;
}

/// If cleaning removes almost nothing, as usual, its planes serve the normals. @returns whether this did it all.
bool prepare_clean_cloud(const PointCloud& cloud, const PrepareOptions& options, PreparedCloud& prepared,
                         Stopwatch& watch, const RunContext& run) {
  if (!options.clean.remove_outliers || cloud.size() > options.clean.point_budget) return false;
  // If this fails, cleaning starts again, and this counts as its first pass.
  const StageShare cleaning("clean", cloud.size(), "points");
  const StageShare trial = cleaning.part(0, 0.25);
  const LocalFits fits =
      fit_locally(cloud, plane_neighbours(prepared.scale), prepared.scale.noise, run, trial.part(0, 0.9));
  if (has_duplicates(fits)) return false;
  const std::vector<PointFate> fates =
      judge_points(fits, prepared.scale, Strictness::trusting, run, trial.part(0.9, 1));
  const std::vector<bool> is_dense = dense_points(fits, prepared.scale);
  const KeptPoints kept = kept_points(fates, fits, [&](std::uint32_t i) { return is_dense[i]; });
  if (is_much(cloud.size() - kept.sure.size(), cloud.size())) return false;
  cleaning.report(run, 1);
  prepared.clean_seconds = watch.lap();
  EstimatedNormals estimated =
      orient_fits(cloud, fits, prepared.scale, run, StageShare("normals", cloud.size(), "points"));
  PointCloud oriented = cloud;
  oriented.normals = std::move(estimated.normals);
  prepared.normals_seconds = watch.lap();
  const std::vector<std::uint32_t> left = both(kept);
  prepared.cloud = select_points(oriented, left);
  prepared.doubted = places_in(left, kept.doubted);
  prepared.cleaning.isolated = kept.isolated;
  prepared.cleaning.off_surface = kept.off_surface;
  warn_of_noise(prepared);
  note_normals(prepared, cloud, estimated, kept.doubted);
  return true;
}

}  // namespace

PreparedCloud prepare_cloud(const PointCloud& cloud, const PrepareOptions& options, const RunContext& run) {
  Stopwatch watch;
  PreparedCloud prepared{.cloud = {}, .scale = estimate_scale(cloud, run), .cleaning = {}};
  if (options.is_exact) {
    prepared.cloud = cloud;
    prepared.scale.noise = 0;
    return prepared;
  }
  const bool has_given_normals = options.keep_normals && cloud.has_normals();
  if (!has_given_normals && prepare_clean_cloud(cloud, options, prepared, watch, run)) return prepared;
  CleanCloud clean = clean_cloud(cloud, prepared.scale, options.clean, run);
  prepared.cloud = std::move(clean.cloud);
  prepared.cleaning = clean.report;
  prepared.doubted = std::move(clean.doubted);
  // Outliers and duplicates distorted the first estimate.
  const PointCloud sure = without_points(prepared.cloud, prepared.doubted);
  if (is_much(cloud.size() - sure.size(), cloud.size())) prepared.scale = estimate_scale(sure, run);
  warn_of_noise(prepared);
  prepared.clean_seconds = watch.lap();
  const bool are_good = has_given_normals && keep_given_normals(prepared, sure, run);
  prepared.normals_seconds = watch.seconds();
  if (are_good) return prepared;
  EstimatedNormals estimated = estimate_normals(prepared.cloud, prepared.scale, run);
  prepared.cloud.normals = std::move(estimated.normals);
  prepared.normals_seconds = watch.seconds();
  note_normals(prepared, prepared.cloud, estimated, prepared.doubted);
  return prepared;
}

}  // namespace cloud2csg
