#include "io/step/host.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cloud2csg/mesh.hpp"
#include "core/base/files.hpp"
#include "core/fields/tree_volume.hpp"
#include "core/geometry/boxes.hpp"
#include "io/step/balance_facets.hpp"
#include "io/step/kernel_solids.hpp"
#include "io/step/step_text.hpp"

namespace cloud2csg::brep {

ModelHost::ModelHost(const KernelJob& job, const Model& model, const AlignedBox& extent, const BrepOptions& options,
                     const RunContext& run, std::vector<std::string> names)
    : job_(job),
      primitives_(model.primitives),
      extent_(extent),
      options_(options),
      run_(run),
      quiet_{.stop = run.stop, .on_progress = {}, .threads = 1},
      used_(primitives_of(tree_of(model))),
      names_(std::move(names)) {}

KernelSolid ModelHost::solid_of(PrimitiveIndex primitive) const {
  if (has_exact_surfaces(primitives_[primitive])) return kernel_solid(primitives_[primitive], extent_, job_.frame);
  return {.shape = facets_of({.primitives = primitives_, .tree = CsgTree::leaf(primitive)})};
}

std::optional<VolumeEstimate> ModelHost::volume_of(std::size_t node) const {
  constexpr int k_coarse = 6;
  constexpr int k_fine = 8;
  const Model part{.primitives = primitives_, .tree = tree_of(job_.plan, node)};
  const AlignedBox box = cloud2csg::bounds_of(part);
  if (box.isEmpty()) return VolumeEstimate();
  if (!is_finite(box)) return {};
  const double cube = std::pow(job_.frame.scale, 3);
  VolumeEstimate estimate;
  for (int levels = k_coarse; levels <= k_fine; ++levels) {
    estimate = tree_volume(part, box, levels, quiet_);
    if (estimate.error <= 0.2 * options_.volume_tolerance * estimate.volume) break;
  }
  return VolumeEstimate{.volume = estimate.volume / cube, .error = estimate.error / cube};
}

Facets ModelHost::facets_of(std::size_t node) const {
  return facets_of({.primitives = primitives_, .tree = tree_of(job_.plan, node)});
}

Facets ModelHost::facets_of(const Model& part) const {
  // Exact corners may bring overlapping triangles, which would make the solid invalid.
  TriangleMesh mesh =
      mesh_surface(part, extent_, {.resolution = options_.facet_resolution, .corners_first = false}, quiet_);
  balance_facets(mesh, part);
  return kernel_facets(mesh, job_.frame);
}

void ModelHost::name_step(const std::filesystem::path& file) const {
  write_text_file(file, with_names(read_text_file(file), names_));
}

PrimitiveIndex ModelHost::primitive_at(const std::vector<Eigen::Vector3d>& points) const {
  Points in_model;
  for (const Eigen::Vector3d& point : points) in_model.push_back(job_.frame.scale * point + job_.frame.offset);
  PrimitiveIndex best = used_.front();
  double least = std::numeric_limits<double>::infinity();
  for (const PrimitiveIndex index : used_) {
    double farthest = 0;
    for (const double value : signed_distance(primitives_[index], in_model))
      farthest = std::max(farthest, std::abs(value));
    // Among coincident faces, prefers the first primitive.
    constexpr double k_same = 1e-9;
    if (farthest < least - k_same * job_.size * job_.frame.scale) {
      least = farthest;
      best = index;
    }
  }
  return best;
}

}  // namespace cloud2csg::brep
