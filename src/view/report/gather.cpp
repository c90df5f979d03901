#include "view/report/gather.hpp"

#include <algorithm>
#include <optional>
#include <span>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "shape/mesh/model_extent.hpp"
#include "view/report/cloud_sections.hpp"
#include "view/report/deviation.hpp"
#include "view/report/payload.hpp"
#include "view/report/solid_sections.hpp"

#ifndef CLOUD2CSG_VERSION
#error "the build names the version"
#endif

namespace cloud2csg {
namespace {

using Json = Payload::Json;

Json summary_json(const DeviationSummary& s) {
  return {{"points", s.points},    {"mean", s.mean}, {"standard_deviation", s.standard_deviation},
          {"rms", s.rms},          {"p95", s.p95},   {"least", s.least},
          {"greatest", s.greatest}};
}

Json point_json(const Eigen::Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

Json deviation_json(const Deviation& deviation, const PointCloud& cloud, double noise) {
  Json by_primitive = Json::array();
  for (const OwnerDeviation& owner : deviation.by_primitive) {
    Json entry = summary_json(owner.summary);
    entry["primitive"] = owner.primitive;
    by_primitive.push_back(std::move(entry));
  }
  Json worst = Json::array();
  for (const std::uint32_t i : deviation.worst) {
    worst.push_back({{"position", point_json(cloud.positions[i])},
                     {"distance", deviation.fit.signed_distances[i]},
                     {"primitive", deviation.fit.owners[i]}});
  }
  constexpr double k_sigmas = 3;
  const auto beyond = std::count_if(deviation.fit.signed_distances.begin(), deviation.fit.signed_distances.end(),
                                    [&](double distance) { return !(std::abs(distance) <= k_sigmas * noise); });
  return {{"all", summary_json(deviation.summary)},
          {"noise", noise},
          {"beyond_three_noises", beyond},
          {"by_primitive", std::move(by_primitive)},
          {"worst", std::move(worst)}};
}

Json overlap_json(const PrimitiveSet& primitives, double tolerance, const RunContext& run) {
  // More than that nobody reads; and what has more is slow to list.
  constexpr std::size_t k_most_primitives = 2000;
  constexpr std::size_t k_most_edges = 20'000;
  constexpr std::size_t k_most_cliques = 2000;
  if (primitives.size() > k_most_primitives) return nullptr;
  const OverlapGraph graph = build_overlap_graph(primitives, {.tolerance = tolerance, .extents = {}}, run);
  if (graph.edge_count() > k_most_edges) return nullptr;
  Json edges = Json::array();
  for (PrimitiveIndex a = 0; a < graph.size(); ++a) {
    for (const PrimitiveIndex b : graph.neighbours[a]) {
      if (a < b) edges.push_back({a, b});
    }
  }
  std::vector<Clique> cliques = maximal_cliques(graph);
  const std::size_t count = cliques.size();
  std::stable_sort(cliques.begin(), cliques.end(),
                   [](const Clique& a, const Clique& b) { return a.size() > b.size(); });
  cliques.resize(std::min(count, k_most_cliques));
  return {{"tolerance", tolerance}, {"edges", std::move(edges)}, {"clique_count", count}, {"cliques", cliques}};
}

Json parameters_json(std::span<const ReportParameter> parameters) {
  Json list = Json::array();
  for (const ReportParameter& p : parameters) {
    list.push_back({{"group", p.group}, {"name", p.name}, {"value", p.value}});
  }
  return list;
}

Json downloads_json(const Report& report, Payload& payload) {
  Json list = Json::array();
  for (const ReportDownload& download : report.downloads) {
    list.push_back({{"name", download.name}, {"content", payload.add_bytes(download.content)}});
  }
  return list;
}

double noise_of(const Report& report, const Deviation& deviation) {
  return report.statistics && report.statistics->noise > 0 ? report.statistics->noise : deviation.noise;
}

}  // namespace

std::string gather_payload(const Report& report, const ReportOptions& options, const RunContext& loud) {
  constexpr std::size_t k_steps = 3;
  // Dozens of meshes are one step to who waits for the report.
  const RunContext run{.stop = loud.stop, .on_progress = {}, .threads = loud.threads};
  loud.report("report", 0, k_steps);
  const Model& model = report.model;
  Payload payload;
  Json json{{"program", "cloud2csg " CLOUD2CSG_VERSION}, {"title", report.title}, {"source", report.source}};
  json["primitives"] = Json::parse(to_json(Model{.primitives = model.primitives}))["primitives"];
  const AlignedBox extent = model_extent(model);
  json["solid"] = solid_sections(model, extent, options, run, payload);

  loud.report("report", 1, k_steps);
  double tolerance = 1e-6 * extent.diagonal().norm();
  if (report.cloud && !report.cloud->positions.empty() && !is_constant(*model.tree)) {
    const Deviation deviation = measure_deviation(model, *report.cloud, run);
    tolerance = noise_of(report, deviation);
    json["cloud"] = cloud_sections(*report.cloud, deviation, options.most_points, payload);
    json["deviation"] = deviation_json(deviation, *report.cloud, tolerance);
  }
  loud.report("report", 2, k_steps);
  json["overlap"] = overlap_json(model.primitives, tolerance, run);
  json["statistics"] = report.statistics ? Json::parse(to_json(*report.statistics)) : Json(nullptr);
  json["parameters"] = parameters_json(report.parameters);
  json["warnings"] = report.warnings;
  json["downloads"] = downloads_json(report, payload);
  loud.report("report", k_steps, k_steps);
  return payload.bytes(json);
}

}  // namespace cloud2csg
