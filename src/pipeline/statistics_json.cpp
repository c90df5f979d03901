#include <nlohmann/json.hpp>

#include "cloud2csg/extract.hpp"

#ifndef CLOUD2CSG_VERSION
#error "the build names the version"
#endif

namespace cloud2csg {
namespace {

using Json = nlohmann::ordered_json;

Json seconds_json(const StageSeconds& s) {
  return {{"read", s.read},
          {"clean", s.clean},
          {"normals", s.normals},
          {"detect", s.detect},
          {"segment", s.segment},
          {"overlap", s.overlap},
          {"partition", s.partition},
          {"classes", s.classes},
          {"search", s.search},
          {"merge", s.merge},
          {"simplify", s.simplify},
          {"write", s.write},
          {"extraction", s.extraction},
          {"total", s.total}};
}

/// Of each stage in the extraction.
Json share_json(const StageSeconds& s) {
  const auto share = [&s](double seconds) { return s.extraction > 0 ? seconds / s.extraction : 0.0; };
  return {{"segment", share(s.segment)},  {"overlap", share(s.overlap)}, {"partition", share(s.partition)},
          {"classes", share(s.classes)},  {"search", share(s.search)},   {"merge", share(s.merge)},
          {"simplify", share(s.simplify)}};
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
          {"is_minimal", s.is_minimal}};
}

Json tree_json(const TreeStatistics& tree) {
  return {{"size", tree.size}, {"leaves", tree.leaves}, {"depth", tree.depth}};
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
                     {"cells", s.cells ? cells_json(*s.cells) : Json(nullptr)},
                     {"tree_before_simplification", tree_json(s.before_simplification)},
                     {"tree", tree_json(s.tree)},
                     {"fit",
                      {{"objective", s.fit.objective},
                       {"rms_distance", s.fit.rms_distance},
                       {"p95_distance", s.fit.p95_distance},
                       {"rms_angle_deg", s.fit.rms_angle_deg},
                       {"p95_angle_deg", s.fit.p95_angle_deg}}},
                     {"warnings", s.warnings}};
  return json.dump(2) + "\n";
}

}  // namespace cloud2csg
