#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Its fields: see the table.
struct CompareOptions {
  int resolution = 256;
  std::size_t surface_samples = 100'000;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<CompareOptions>, auto&& field) {
  using O = CompareOptions;
  field(&O::resolution, "resolution",
        "Volumes: columns along the longest side of the joint bounds. About the square of it in all.",
        from_to(2, 8192));
  field(&O::surface_samples, "surface_samples", "Distances: points on each surface that is not a cloud", at_least(1),
        {.option = "samples"});
  field(&O::seed, k_seed);
}

/// How alike two solids are. What cannot be had from the inputs (a volume from a cloud or from a mesh with holes, a
/// tree from a mesh) is absent.
struct Comparison {
  /// Of the volumes, 1 = the same, exactly so for equal inputs. Both solids are cut by the same columns, so that the
  /// errors of the volumes (about 2e-4 of them at the default resolution) hardly show in it.
  std::optional<double> intersection_over_union;
  std::optional<double> volume_truth, volume_result;
  /// Mean over samples of both surfaces, and the largest, of the distance to the other surface. Distances to meshes are
  /// exact; to models exact or, beside edges and for displaced and expression solids, off by about 1e-5 of the
  /// size; to clouds they are those to the nearest point, too large by up to the spacing of the points.
  double mean_distance = 0;  ///< mean of the two one-sided means
  double hausdorff_distance =
      0;  ///< the larger of the two one-sided maxima; the maximum is over samples, a lower bound
  /// Result / truth, of the trees as they are written. depth_ratio is absent when only the truth is a single leaf.
  std::optional<double> size_ratio, depth_ratio;
};

/// One of a model with a tree, a mesh, a cloud.
struct Shape3d {
  std::optional<Model> model = {};
  std::optional<TriangleMesh> mesh = {};
  std::optional<PointCloud> cloud = {};
};

/// By the file's ending: .json .scad .csg a model, .stl .off .obj .3mf .glb a mesh, .xyz .xyzn .pcd .pts .txt a cloud,
/// .ply a mesh when it has faces, else a cloud. @throws Error
[[nodiscard]] Shape3d read_shape(const std::filesystem::path& file);

/// O(resolution^2 x cuts x primitives + samples log triangles). The result does not depend on the number of threads.
/// @throws Error when a shape is none or several of the three, empty, unbounded, or a model without a tree; Cancelled.
[[nodiscard]] Comparison compare(const Shape3d& truth, const Shape3d& result, const CompareOptions& options = {},
                                 const RunContext& run = {});

}  // namespace cloud2csg
