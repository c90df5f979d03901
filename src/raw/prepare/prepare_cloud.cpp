#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cloud2csg/advanced/prepare.hpp"
#include "core/base/run.hpp"
#include "core/geometry/subset.hpp"
#include "raw/prepare/constants.hpp"
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

/// Whether removing so many points changes the rest noticeably.
bool is_much(std::size_t left_out, std::size_t points) {
  return static_cast<double>(left_out) >= k_negligible_share * static_cast<double>(points);
}

/// Cleans the cloud. Its normals play no part.
PreparedCloud cleaned(const PointCloud& cloud, const CleanOptions& options, PreparedCloud prepared,
                      const RunContext& run) {
  const Stopwatch watch;
  CleanCloud clean = clean_cloud(cloud, prepared.scale, options, run);
  prepared.cloud = std::move(clean.cloud);
  prepared.cleaning = clean.report;
  prepared.doubted = std::move(clean.doubted);
  // Outliers and duplicates distorted the first estimate.
  const PointCloud sure = without_points(prepared.cloud, prepared.doubted);
  if (is_much(cloud.size() - sure.size(), cloud.size())) prepared.scale = estimate_scale(sure, run);
  warn_of_noise(prepared);
  prepared.clean_seconds = watch.seconds();
  return prepared;
}

/// Keeps the given normals if those of the sure points are good; else the result is absent.
std::optional<PreparedCloud> prepare_with_normals(const PointCloud& cloud, const PrepareOptions& options,
                                                  const PreparedCloud& measured, const RunContext& run) {
  PreparedCloud prepared = cleaned(cloud, options.clean, measured, run);
  const Stopwatch watch;
  const PointCloud sure = without_points(prepared.cloud, prepared.doubted);
  const NormalsVerdict verdict = check_normals(sure, prepared.scale, run);
  if (verdict == NormalsVerdict::unoriented) return std::nullopt;
  if (verdict == NormalsVerdict::inward) {
    turn(prepared.cloud.normals);
    prepared.warnings.emplace_back("The normals pointed into the solid and were turned.");
  }
  prepared.normals_seconds = watch.seconds();
  return prepared;
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

bool has_duplicates(const LocalFits& fits) {
  for (std::size_t i = 0; i < fits.points.size(); ++i) {
    const std::span<const float> distances = fits.neighbours.distances_of(i);
    if (!distances.empty() && distances.front() == 0.0F) return true;
  }
  return false;
}

/// If cleaning removes almost nothing, as usual, its planes serve the normals; else the result is absent.
std::optional<PreparedCloud> prepare_clean_cloud(const PointCloud& cloud, const CleanOptions& options,
                                                 PreparedCloud prepared, const RunContext& run) {
  if (!options.remove_outliers || cloud.size() > options.point_budget) return std::nullopt;
  Stopwatch watch;
  // If this fails, cleaning starts again, and this counts as its first pass.
  const StageShare cleaning("clean", cloud.size(), "points");
  const StageShare trial = cleaning.part(0, 0.25);
  const LocalFits fits =
      fit_locally(cloud, plane_neighbours(prepared.scale), prepared.scale.noise, run, trial.part(0, 0.9));
  if (has_duplicates(fits)) return std::nullopt;
  const std::vector<PointFate> fates =
      judge_points(fits, prepared.scale, Strictness::trusting, run, trial.part(0.9, 1));
  const std::vector<bool> is_dense = dense_points(fits, prepared.scale);
  const KeptPoints kept = kept_points(fates, fits, [&](std::uint32_t i) { return is_dense[i]; });
  if (is_much(cloud.size() - kept.sure.size(), cloud.size())) return std::nullopt;
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
  return prepared;
}

/// Estimates the normals. Given ones play no part.
PreparedCloud prepare_positions(const PointCloud& cloud, const PrepareOptions& options, const PreparedCloud& measured,
                                const RunContext& run) {
  if (std::optional<PreparedCloud> prepared = prepare_clean_cloud(cloud, options.clean, measured, run)) {
    return *std::move(prepared);
  }
  PreparedCloud prepared = cleaned(cloud, options.clean, measured, run);
  const Stopwatch watch;
  EstimatedNormals estimated = estimate_normals(prepared.cloud, prepared.scale, run);
  prepared.cloud.normals = std::move(estimated.normals);
  prepared.normals_seconds = watch.seconds();
  note_normals(prepared, prepared.cloud, estimated, prepared.doubted);
  return prepared;
}

}  // namespace

PreparedCloud prepare_cloud(const PointCloud& cloud, const PrepareOptions& options, const RunContext& run) {
  PreparedCloud measured{.cloud = {}, .scale = estimate_scale(cloud, run), .cleaning = {}};
  if (options.is_exact) {
    measured.cloud = cloud;
    measured.scale.noise = 0;
    return measured;
  }
  if (!options.keep_normals || !cloud.has_normals()) return prepare_positions(cloud, options, measured, run);
  const Stopwatch watch;
  if (std::optional<PreparedCloud> prepared = prepare_with_normals(cloud, options, measured, run)) {
    return *std::move(prepared);
  }
  const double in_vain = watch.seconds();
  // Start anew, so that the result is that of a cloud without normals. Progress would start anew, too.
  RunContext silent = run;
  silent.on_progress = {};
  PreparedCloud prepared = prepare_positions(cloud, options, measured, silent);
  prepared.normals_seconds += in_vain;
  prepared.warnings.emplace_back("The normals contradicted the surface or each other and were estimated again.");
  return prepared;
}

}  // namespace cloud2csg
