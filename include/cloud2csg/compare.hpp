#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

struct CompareOptions {
  int resolution = 256;
  std::size_t surface_samples = 100'000;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<CompareOptions>, auto&& field) {
  using O = CompareOptions;
  field(&O::resolution, "resolution",
        "Columns along the longest side of the joint bounds, to measure volumes. In all, about the square of this "
        "number.",
        from_to(2, 8192));
  field(&O::surface_samples, "surface_samples",
        "Sample points on each surface that is not a cloud, to measure distances", at_least(1), {.option = "samples"});
  field(&O::seed, k_seed);
}

/// How alike two solids are. A value is absent without the data for it: clouds and open meshes have no volume.
struct Comparison {
  /// Intersection over union of the two volumes: exactly 1 for equal inputs. Both solids are cut by the same columns,
  /// so the errors of the volumes (relative 2e-4 at the default resolution) nearly cancel.
  std::optional<double> intersection_over_union;
  std::optional<double> volume_truth, volume_result;
  /// Distances from samples of each surface to the other surface. They are exact for meshes and for most models. Near
  /// edges and for displaced and expression solids they are off by about 1e-5 of the size. Distances to a cloud go to
  /// its nearest point and are too large by up to the point spacing.
  double mean_distance = 0;       ///< mean of the two one-sided means
  double hausdorff_distance = 0;  ///< larger of the two one-sided maxima over the samples: a lower bound
  /// Result / truth, for the trees as written. depth_ratio is absent when only the true tree is a single leaf.
  std::optional<double> size_ratio, depth_ratio;
};

/// Holds exactly one of a model with a tree, a mesh and a cloud.
struct Shape3d {
  std::optional<Model> model = {};
  std::optional<TriangleMesh> mesh = {};
  std::optional<PointCloud> cloud = {};
};

/// Reads a shape by the file's ending: a model from .json .scad .csg, a mesh from .stl .off .obj .3mf .glb, a cloud
/// from .xyz .xyzn .pcd .pts .txt. A .ply is a mesh when it has faces, else a cloud. @throws Error
[[nodiscard]] Shape3d read_shape(const std::filesystem::path& file);

/// O(resolution^2 x cuts x primitives + samples log triangles). The result does not depend on the number of threads.
/// @throws Error unless a shape is one of the three, not empty, bounded and not a model without a tree; Cancelled.
[[nodiscard]] Comparison compare(const Shape3d& truth, const Shape3d& result, const CompareOptions& options = {},
                                 const RunContext& run = {});

}  // namespace cloud2csg
