#include <algorithm>
#include <nlohmann/json.hpp>

#include "cloud2csg/extract.hpp"

#ifndef CLOUD2CSG_VERSION
#error "the build names the version"
#endif

namespace cloud2csg {
namespace {

using Json = nlohmann::ordered_json;

Json seconds_json(const StageSeconds& s) {
  return {{"read", s.read},       {"clean", s.clean},     {"normals", s.normals},       {"detect", s.detect},
          {"solids", s.solids},   {"segment", s.segment}, {"overlap", s.overlap},       {"partition", s.partition},
          {"classes", s.classes}, {"search", s.search},   {"merge", s.merge},           {"simplify", s.simplify},
          {"refine", s.refine},   {"write", s.write},     {"extraction", s.extraction}, {"total", s.total}};
}

/// Share of each stage in the extraction.
Json share_json(const StageSeconds& s) {
  const auto share = [&s](double seconds) { return s.extraction > 0 ? seconds / s.extraction : 0.0; };
  return {{"segment", share(s.segment)},   {"overlap", share(s.overlap)}, {"partition", share(s.partition)},
          {"classes", share(s.classes)},   {"search", share(s.search)},   {"merge", share(s.merge)},
          {"simplify", share(s.simplify)}, {"refine", share(s.refine)}};
}

Json search_json(const std::vector<PartitionStatistics>& partitions) {
  std::size_t generations = 0;
  std::size_t evaluations = 0;
  Json list = Json::array();
  for (const PartitionStatistics& p : partitions) {
    generations += p.generations;
    evaluations += p.evaluations;
    list.push_back({{"primitives", p.primitives},
                    {"points", p.points},
                    {"classes", p.classes},
                    {"generations", p.generations},
                    {"evaluations", p.evaluations},
                    {"objective", p.score},
                    {"tree_size", p.tree_size}});
  }
  return {{"generations", generations}, {"evaluations", evaluations}, {"partitions", std::move(list)}};
}

Json merge_json(const MergeStatistics& merge) {
  Json ways = Json::array();
  for (const MergeWay way : merge.ways) ways.push_back(to_string(way));
  return {{"ways", std::move(ways)},
          {"merges", merge.merges},
          {"blocked", merge.blocked},
          {"failed_checks", merge.failed_checks},
          {"joint_solutions", merge.joint_solutions},
          {"worst_shortfall", merge.worst_shortfall},
          {"generations", merge.generations},
          {"evaluations", merge.evaluations}};
}

Json cells_json(const CellStatistics& s) {
  return {{"cells", s.cells},
          {"patches", s.patches},
          {"open_cells", s.open_cells},
          {"open_volume", s.open_volume},
          {"speaking_points", s.speaking_points},
          {"contradicted_points", s.contradicted_points},
          {"peeled", s.peeled},
          {"cores", s.cores},
          {"least_leaves", s.least_leaves ? Json(*s.least_leaves) : Json(nullptr)},
          {"is_minimal", s.is_minimal}};
}

Json refine_json(const RefineStatistics& s) {
  Json changes = Json::array();
  double largest_shift = 0;
  double largest_turn = 0;
  for (const PrimitiveChange& change : s.changes) {
    changes.push_back({{"points", change.points},
                       {"largest_shift", change.largest_shift},
                       {"turn_deg", change.turn_deg},
                       {"rms_before", change.rms_before},
                       {"rms_after", change.rms_after}});
    largest_shift = std::max(largest_shift, change.largest_shift);
    largest_turn = std::max(largest_turn, change.turn_deg);
  }
  Json regularities = Json::array();
  for (const Regularity& regularity : s.regularities) {
    regularities.push_back(
        {{"type", to_string(regularity.type)}, {"primitives", regularity.primitives}, {"spread", regularity.spread}});
  }
  return {{"is_taken", s.is_taken},
          {"rounds", s.rounds},
          {"points", s.points},
          {"rms_before", s.rms_before},
          {"rms_after", s.rms_after},
          {"largest_shift", largest_shift},
          {"largest_turn_deg", largest_turn},
          {"primitives", std::move(changes)},
          {"regularities", std::move(regularities)}};
}

/// Each entry has the index (from 0) and the type of the changed surface.
Json snaps_json(const FindingStatistics& s) {
  Json list = Json::array();
  for (const Snap& snap : s.snaps) {
    list.push_back({{"kind", to_string(snap.kind)},
                    {"surface", snap.surface},
                    {"type", type_name(s.surfaces[snap.surface])},
                    {"change", snap.change}});
  }
  return list;
}

Json closed_json(const std::vector<ClosedSurface>& surfaces) {
  Json list = Json::array();
  for (const ClosedSurface& closed : surfaces) {
    list.push_back({{"reason", to_string(closed.reason)},
                    {"type", type_name(closed.type)},
                    {"place", {closed.place.x(), closed.place.y(), closed.place.z()}},
                    {"added_points", closed.added_points},
                    {"seen", closed.seen}});
  }
  return list;
}

Json rounds_json(const std::vector<ChoiceRound>& rounds) {
  Json list = Json::array();
  for (const ChoiceRound& round : rounds) {
    list.push_back({{"planes", round.planes},
                    {"places", round.places},
                    {"leaves", round.leaves},
                    {"disagreement", round.disagreement}});
  }
  return list;
}

Json finding_json(const FindingStatistics& s) {
  const auto count = [&s](SurfaceType type) { return std::ranges::count(s.surfaces, type); };
  const LargestChange largest = largest_change(s.snaps);
  return {{"raw_points", s.raw_points},
          {"smoothed_points", s.smoothed_points},
          {"closed", closed_json(s.closed)},
          {"added_points", s.added_points},
          {"normals_estimated", s.normals_estimated},
          {"diagonal", s.diagonal},
          {"spacing", s.spacing},
          {"noise", s.noise},
          {"tolerance", s.tolerance},
          {"surfaces", s.surfaces.size()},
          {"planes", count(SurfaceType::plane)},
          {"spheres", count(SurfaceType::sphere)},
          {"cylinders", count(SurfaceType::cylinder)},
          {"cones", count(SurfaceType::cone)},
          {"tori", count(SurfaceType::torus)},
          {"unexplained_points", s.unexplained_points},
          {"known", s.known},
          {"known_points", s.known_points},
          {"largest_turn_deg", largest.turn_deg},
          {"largest_shift", largest.shift},
          {"snaps", snaps_json(s)},
          {"rounds", rounds_json(s.rounds)},
          {"disagreement", s.disagreement}};
}

Json regions_json(const std::vector<UnexplainedRegion>& regions) {
  Json list = Json::array();
  for (const UnexplainedRegion& region : regions) {
    list.push_back({{"points", region.points},
                    {"place", {region.place.x(), region.place.y(), region.place.z()}},
                    {"size", region.size}});
  }
  return list;
}

Json optional_json(const std::optional<double>& figure) {
  return figure ? Json(*figure) : Json(nullptr);
}

Json verdict_json(const Verdict& verdict) {
  const auto judged = [&](auto figure) { return verdict.points > 0 ? Json(figure) : Json(nullptr); };
  return {{"grade", to_string(verdict.grade)},
          {"text", to_text(verdict)},
          {"points", judged(verdict.points)},
          {"share_within", judged(verdict.share_within)},
          {"distance", judged(verdict.distance)},
          {"unexplained_points", judged(verdict.unexplained_points)},
          {"disagreement", optional_json(verdict.disagreement)},
          {"bare_surface", optional_json(verdict.bare_surface)},
          {"closed_surface", optional_json(verdict.closed_surface)},
          {"doubts", verdict.doubts},
          {"regions", regions_json(verdict.regions)}};
}

Json tree_json(const TreeStatistics& tree) {
  return {{"size", tree.size},     {"leaves", tree.leaves}, {"depth", tree.depth},
          {"levels", tree.levels}, {"price", tree.price},   {"operations", tree.operations}};
}

Json steps_json(const std::vector<TreeStep>& steps) {
  Json list = Json::array();
  for (const TreeStep& step : steps) list.push_back({{"name", step.name}, {"size", step.size}});
  return list;
}

}  // namespace

std::string to_json(const ExtractStatistics& s) {
  const Json json = {{"version", CLOUD2CSG_VERSION},
                     {"strategy", to_string(s.strategy)},
                     {"parallel", to_string(s.parallel)},
                     {"threads", s.threads},
                     {"seed", s.seed},
                     {"complete", s.complete},
                     {"points", s.points},
                     {"unassigned_points", s.unassigned_points},
                     {"primitives", s.primitives},
                     {"noise", s.noise},
                     {"clique_histogram", s.clique_histogram},
                     {"components", s.components},
                     {"seconds", seconds_json(s.seconds)},
                     {"share", share_json(s.seconds)},
                     {"search", search_json(s.partitions)},
                     {"merge", merge_json(s.merge)},
                     {"finding", s.finding ? finding_json(*s.finding) : Json(nullptr)},
                     {"cells", s.cells ? cells_json(*s.cells) : Json(nullptr)},
                     {"refine", s.refine ? refine_json(*s.refine) : Json(nullptr)},
                     {"steps", steps_json(s.steps)},
                     {"tree_before_simplification", tree_json(s.before_simplification)},
                     {"tree", tree_json(s.tree)},
                     {"fit",
                      {{"objective", s.fit.objective},
                       {"rms_distance", s.fit.rms_distance},
                       {"p95_distance", s.fit.p95_distance},
                       {"rms_angle_deg", s.fit.rms_angle_deg},
                       {"p95_angle_deg", s.fit.p95_angle_deg},
                       {"unexplained_points", s.fit.unexplained_points}}},
                     {"verdict", verdict_json(s.verdict)},
                     {"warnings", s.warnings}};
  return json.dump(2) + "\n";
}

std::string to_json(const Verdict& verdict) {
  return verdict_json(verdict).dump();
}

}  // namespace cloud2csg
