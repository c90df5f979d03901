#include "view/report/solid_sections.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cloud2csg/error.hpp"
#include "core/fields/point_fit.hpp"
#include "view/report/light_mesh.hpp"
#include "view/report/shown_tree.hpp"

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

/// Makes meshes as long as the budget lasts.
class MeshBudget {
 public:
  MeshBudget(const Model& model, const AlignedBox& extent, const ReportOptions& options, const RunContext& run,
             Payload& payload)
      : model_(model), extent_(extent), options_(options), run_(run), payload_(payload) {}

  /// The number of the mesh, or none where the budget is spent.
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

/// Of many parts each is coarser: the time that a mesh takes goes with the square of it.
int resolution_of_parts(std::size_t parts, const ReportOptions& options) {
  constexpr double k_few = 40;
  constexpr int k_least = 24;
  if (static_cast<double>(parts) <= k_few || options.part_resolution <= k_least) return options.part_resolution;
  const double share = std::sqrt(k_few / static_cast<double>(std::min(parts, options.most_meshes)));
  return std::max(k_least, static_cast<int>(options.part_resolution * std::min(1.0, share)));
}

/// The whole solid first, then primitives, which are what a tree is read by, then inner nodes, those near the root
/// first.
MeshOfNode add_meshes(const CsgTree& tree, const std::vector<ShownNode>& nodes, const ReportOptions& options,
                      MeshBudget& budget) {
  constexpr std::size_t k_share_of_part = 8;  // of the triangles of the whole
  const std::size_t most_of_part = std::max<std::size_t>(options.most_triangles / k_share_of_part, 1);
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

}  // namespace

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

}  // namespace cloud2csg
