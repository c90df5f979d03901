#include "pipeline/find_primitives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/run.hpp"
#include "pipeline/close_unseen.hpp"
#include "pipeline/detect_rest.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/time_limit.hpp"

namespace cloud2csg {
namespace {

void check_known(const PrimitiveSet& known) {
  std::set<std::string> ids;
  for (const Primitive& primitive : known) {
    const std::string where = fmt::format("known primitive '{}'", primitive.id);
    if (!ids.insert(primitive.id).second) {
      throw Error({.where = where, .expected = "another has the same id"});
    }
    try {
      validate(primitive);
    } catch (const Error& error) {
      Error::Parts parts = error.parts();
      parts.where = where + ": " + parts.where;
      throw Error(std::move(parts));
    }
  }
}

/// Tells of each solid which points lie on it.
void add_evidence(FoundPrimitives& found, const DetectOptions& options, const RunContext& run) {
  PrimitiveSet& solids = found.choice.solids;
  found.points = deal_points(found.prepared.cloud, solids, tolerances_of(options, found.prepared.scale), run);
  for (std::size_t k = 0; k < solids.size(); ++k) {
    solids[k].evidence = Evidence{.points = found.points[k].points.size(), .rms = found.points[k].rms};
  }
}

/// find_primitives() without a word on known primitives.
FoundPrimitives find_all(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  check_known(options.known);
  Stopwatch watch;
  FoundPrimitives found;
  found.prepared = prepare_cloud(cloud, options.preparation, run);
  watch.lap();
  found.warnings = found.prepared.warnings;

  const std::optional<double>& tolerance = options.detection.distance_tolerance;
  if (tolerance) append(found.warnings, tolerance_warnings(*tolerance, found.prepared.scale.diagonal));
  RestDetection rest = detect_rest(found.prepared.cloud, found.prepared.scale, options.known, options.detection, run);
  append(found.warnings, detection_warnings(rest, found.prepared));
  found.detection = std::move(rest.detection);
  // What is known has ends of its own.
  if (options.close_unseen && options.known.empty()) found = with_unseen_closed(std::move(found), run);
  found.detect_seconds = watch.lap();

  run.report("solids", 0, 0);
  std::vector<KnownSolid> known;
  for (std::size_t k = 0; k < options.known.size(); ++k) {
    known.push_back({.solid = options.known[k], .own = std::move(rest.known[k])});
  }
  SolidOptions solids = options.solids;
  if (!solids.regularity.given_tolerance) solids.regularity.given_tolerance = found.detection.distance_tolerance;
  found.choice = choose_solids(found.prepared.cloud, found.detection.surfaces, known, solids, run);
  if (found.choice.solids.empty()) {
    throw Error({.expected = fmt::format("the surfaces that were found, {} in a cloud of {} points, bound no solid",
                                         found.detection.surfaces.size(), found.prepared.cloud.size()),
                 .remedy = "give a cloud of a closed object, or of most of its surface, of some thousand points"});
  }
  append(found.warnings, found.choice.warnings);
  // The choice may have been cut short, and has a tree all the same.
  add_evidence(found, options.detection, without_stop(run));
  found.choose_seconds = watch.lap();
  return found;
}

}  // namespace

FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  const std::optional<double>& seconds = options.extraction.time_limit_seconds;
  const TimeLimit limit(run.stop, seconds);
  RunContext limited = run;
  limited.stop = limit.token();
  const Stopwatch watch;
  try {
    FoundPrimitives found = find_all(cloud, options, limited);
    if (seconds && *seconds <= watch.seconds()) {
      found.warnings.emplace_back("the time was over while solids were chosen: these are the best so far");
    }
    return found;
  } catch (const Cancelled&) {
    if (run.stop.stop_requested()) throw;
    throw invalid_option("extraction.time_limit_seconds", "the time was over before primitives were found",
                         "allow more, or give a `point_budget` below the number of points");
  }
}

FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t known, std::size_t raw_points) {
  const Scale& scale = found.prepared.scale;
  FindingStatistics statistics{.raw_points = raw_points,
                               .added_points = found.added_points,
                               .normals_estimated = found.prepared.normals_estimated,
                               .diagonal = scale.diagonal,
                               .spacing = scale.spacing,
                               .noise = scale.noise,
                               .tolerance = found.detection.distance_tolerance,
                               .known = known,
                               .known_points = count_of(std::span(found.points).first(known)),
                               .unexplained_points = found.detection.unexplained,
                               .snaps = found.choice.snaps};
  for (const DetectedSurface& s : found.detection.surfaces) statistics.surfaces.push_back(s.surface.type);
  return statistics;
}

}  // namespace cloud2csg
