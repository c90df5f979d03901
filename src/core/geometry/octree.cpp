#include "core/geometry/octree.hpp"

namespace cloud2csg {

OctreeLevel lattice(const AlignedBox& box, const Eigen::Vector3i& counts) {
  const Eigen::Array3d step = box.sizes().array() / counts.cast<double>().array();
  OctreeLevel cells{.centres = {}, .half_size = step / 2};
  for (int i = 0; i < counts.x(); ++i) {
    for (int j = 0; j < counts.y(); ++j) {
      for (int k = 0; k < counts.z(); ++k) {
        cells.centres.push_back(box.min() + (Eigen::Array3d(i + 0.5, j + 0.5, k + 0.5) * step).matrix());
      }
    }
  }
  return cells;
}

OctreeLevel halved(const OctreeLevel& cells, int axis) {
  OctreeLevel halves{.centres = {}, .half_size = cells.half_size};
  halves.half_size[axis] /= 2;
  const Eigen::Vector3d offset = halves.half_size[axis] * Eigen::Vector3d::Unit(axis);
  halves.centres.reserve(2 * cells.centres.size());
  for (std::size_t i = 0; i < cells.centres.size(); ++i) {
    halves.centres.push_back(cells.centres[i] - offset);
    halves.centres.push_back(cells.centres[i] + offset);
  }
  return halves;
}

OctreeLevel octants(const OctreeLevel& cells) {
  return halved(halved(halved(cells, 2), 1), 0);
}

}  // namespace cloud2csg
