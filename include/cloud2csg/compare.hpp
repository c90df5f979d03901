#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

struct CompareOptions {
  int resolution = 256;                  ///< columns along the longest side, for the volumes
  std::size_t surface_samples = 100'000;  ///< points on each surface, for the distances
  std::uint64_t seed = 1;
};

/// How alike two solids are. What cannot be had from the inputs (a volume from a cloud, a tree from a mesh) is absent.
struct Comparison {
  std::optional<double> intersection_over_union;  ///< of the volumes, 1 = the same
  std::optional<double> volume_truth, volume_result;
  double mean_distance = 0;       ///< symmetric mean of the nearest distances between the surfaces
  double hausdorff_distance = 0;  ///< the larger of the two one-sided maxima
  std::optional<double> size_ratio, depth_ratio;  ///< result / truth, of the trees as they are written
};

/// One of a model with a tree, a mesh, a cloud.
struct Shape3d {
  std::optional<Model> model = {};
  std::optional<TriangleMesh> mesh = {};
  std::optional<PointCloud> cloud = {};
};

/// By the file's ending: .json a model, .stl .off .obj a mesh, .xyz .xyzn .pcd .pts .txt a cloud, .ply a mesh when it has
/// faces, else a cloud. @throws Error
[[nodiscard]] Shape3d read_shape(const std::filesystem::path& file);

[[nodiscard]] Comparison compare(const Shape3d& truth, const Shape3d& result, const CompareOptions& options = {},
                                 const RunContext& run = {});

}  // namespace cloud2csg
