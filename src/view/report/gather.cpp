#include "view/report/gather.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/view.hpp"
#include "shape/mesh/model_extent.hpp"
#include "view/report/cloud_sections.hpp"
#include "view/report/deviation.hpp"
#include "view/report/light_mesh.hpp"
#include "view/report/payload.hpp"
#include "view/report/shown_tree.hpp"

#ifndef CLOUD2CSG_VERSION
#error "the build names the version"
#endif
namespace cloud2csg {
namespace {

using Json = Payload::Json;

Json mesh_json(const LightMesh& mesh, Payload& payload) {
  if (mesh.triangles() == 0) return {{"triangles", 0}};
  std::vector<std::uint16_t> owners;
  for (const PrimitiveIndex owner : mesh.owners) {
    owners.push_back(owner >= 65'535 ? std::uint16_t{0} : static_cast<std::uint16_t>(owner + 1));
  }
  const Eigen::Vector3d& least = mesh.bounds.min();
  const Eigen::Vector3d& greatest = mesh.bounds.max();
  return {{"triangles", mesh.triangles()},
          {"least", {least.x(), least.y(), least.z()}},
          {"greatest", {greatest.x(), greatest.y(), greatest.z()}},
          {"positions", payload.add_differences(mesh.positions, 3)},
          {"corners", payload.add_differences(mesh.corners, 3)},
          {"owners", payload.add_plain(owners, 1)}};
}

class MeshBudget {
 public:
  MeshBudget(const Model& model, const AlignedBox& extent, const ReportOptions& options, const RunContext& run,
             Payload& payload)
      : model_(model), extent_(extent), options_(options), run_(run), payload_(payload) {}

  /// The index of the new mesh; absent when the budget is spent.
  std::optional<std::size_t> add(const CsgTree& tree, int resolution, std::size_t most_triangles) {
    const std::size_t left = options_.most_triangles_in_all - std::min(options_.most_triangles_in_all, triangles_);
    if (meshes_.size() >= options_.most_meshes || left < k_fewest_triangles) return {};
    run_.throw_if_stopped();
    const LightMesh mesh = light_mesh({.primitives = model_.primitives, .tree = tree}, extent_, resolution,
                                      std::min(most_triangles, left), run_);
    triangles_ += mesh.triangles();
    meshes_.push_back(mesh_json(mesh, payload_));
    return meshes_.size() - 1;
  }
  [[nodiscard]] Json take() { return std::move(meshes_); }

 private:
  static constexpr std::size_t k_fewest_triangles = 64;
  const Model& model_;
  const AlignedBox& extent_;
  const ReportOptions& options_;
  const RunContext& run_;
  Payload& payload_;
  Json meshes_ = Json::array();
  std::size_t triangles_ = 0;
};

using MeshOfNode = std::vector<std::optional<std::size_t>>;

/// Lowers the resolution for many parts: the time of a mesh grows with its square.
int resolution_of_parts(std::size_t parts, const ReportOptions& options) {
  constexpr double k_few = 40;
  constexpr int k_least = 24;
  if (static_cast<double>(parts) <= k_few || options.part_resolution <= k_least) return options.part_resolution;
  const double share = std::sqrt(k_few / static_cast<double>(std::min(parts, options.most_meshes)));
  return std::max(k_least, static_cast<int>(options.part_resolution * std::min(1.0, share)));
}

/// Order of importance: the whole solid, primitives (by which people read a tree), inner nodes from the root down.
MeshOfNode add_meshes(const CsgTree& tree, const std::vector<ShownNode>& nodes, const ReportOptions& options,
                      MeshBudget& budget) {
  constexpr std::size_t k_parts = 8;  // that get as many triangles together as the whole solid
  const std::size_t most_of_part = std::max<std::size_t>(options.most_triangles / k_parts, 1);
  const int part_resolution = resolution_of_parts(nodes.size(), options);
  MeshOfNode meshes(nodes.size());
  meshes[0] = budget.add(tree, options.resolution, options.most_triangles);
  std::map<PrimitiveIndex, std::optional<std::size_t>> of_primitive;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].operation != Operation::primitive) continue;
    const auto [entry, is_new] = of_primitive.try_emplace(nodes[i].primitive);
    if (is_new) entry->second = budget.add(CsgTree::leaf(nodes[i].primitive), part_resolution, most_of_part);
    meshes[i] = entry->second;
  }
  std::vector<std::size_t> inner;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].operation != Operation::primitive) inner.push_back(i);
  }
  std::stable_sort(inner.begin(), inner.end(),
                   [&](std::size_t a, std::size_t b) { return nodes[a].depth < nodes[b].depth; });
  for (const std::size_t i : inner) {
    meshes[i] = budget.add(CsgTree(tree.subtree(nodes[i].root)), part_resolution, most_of_part);
  }
  return meshes;
}

/// The shown tree and its meshes: {"nodes": [{"operation", "primitive", "children", "mesh"}], "meshes": [...]}. The
/// mesh is null beyond the budget and empty for empty solids. Repeated primitives share a mesh. @throws Cancelled
Json solid_sections(const Model& model, const AlignedBox& extent, const ReportOptions& options, const RunContext& run,
                    Payload& payload) {
  const std::vector<ShownNode> nodes = shown_tree(*model.tree);
  MeshBudget budget(model, extent, options, run, payload);
  const MeshOfNode meshes = add_meshes(*model.tree, nodes, options, budget);
  Json list = Json::array();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool is_leaf = nodes[i].operation == Operation::primitive;
    list.push_back({{"operation", to_string(nodes[i].operation)},
                    {"primitive", is_leaf ? Json(nodes[i].primitive) : Json(nullptr)},
                    {"children", nodes[i].children},
                    {"mesh", meshes[i] ? Json(*meshes[i]) : Json(nullptr)}});
  }
  return {{"nodes", std::move(list)}, {"meshes", budget.take()}};
}

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
  // Larger graphs are unreadable and slow to list.
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
  // For the user, dozens of meshes are one step.
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
