#include "raw/solids/lattice_places.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// The part of a line from `start` along the unit vector `way` that is in the box, from `first` on.
struct Stretch {
  double first, last;
};

Stretch within(const AlignedBox& box, const Vector3d& start, const Vector3d& way, Stretch stretch) {
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) continue;  // points are in the box
    const double one = (box.min()[axis] - start[axis]) / way[axis];
    const double other = (box.max()[axis] - start[axis]) / way[axis];
    stretch.first = std::max(stretch.first, std::min(one, other));
    stretch.last = std::min(stretch.last, std::max(one, other));
  }
  return stretch;
}

}  // namespace

std::size_t LatticePlaces::cell_at(const Vector3d& place) const {
  const Vector3d at = (place - box.min()).cwiseQuotient(box.sizes()).cwiseProduct(cells.cast<double>());
  std::size_t index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    index = index * static_cast<std::size_t>(cells[axis]) +
            static_cast<std::size_t>(std::clamp(static_cast<int>(at[axis]), 0, cells[axis] - 1));
  }
  return index;
}

LatticePlaces stratified(const AlignedBox& box, std::size_t count, RandomStream random) {
  LatticePlaces lattice{.box = box, .cells = {}, .places = {}};
  const double side = std::cbrt(box.volume() / static_cast<double>(count));
  for (int axis = 0; axis < 3; ++axis) {
    lattice.cells[axis] =
        static_cast<int>(std::clamp(std::round(box.sizes()[axis] / side), 1.0, static_cast<double>(count)));
  }
  const Vector3d cell = box.sizes().cwiseQuotient(lattice.cells.cast<double>());
  for (int x = 0; x < lattice.cells.x(); ++x) {
    for (int y = 0; y < lattice.cells.y(); ++y) {
      for (int z = 0; z < lattice.cells.z(); ++z) {
        const Vector3d at(x + random.uniform(), y + random.uniform(), z + random.uniform());
        lattice.places.push_back(box.min() + at.cwiseProduct(cell));
      }
    }
  }
  return lattice;
}

std::vector<SeenCell> seen_cells(const LatticePlaces& lattice, const PointCloud& cloud,
                                 std::span<const std::uint32_t> points, double clear) {
  std::vector<SeenCell> seen;
  if (!cloud.has_sensor_positions()) return seen;
  seen.resize(lattice.places.size());
  const double step = 0.5 * lattice.least_edge();
  for (const std::uint32_t i : points) {
    const Vector3d start = cloud.positions[i];
    const Vector3d line = cloud.sensor_positions[i] - start;
    const double length = line.norm();
    if (!(length > clear) || !std::isfinite(length)) continue;
    const Vector3d way = line / length;
    const Stretch clear_part = within(lattice.box, start, way, {.first = clear, .last = length});
    std::size_t before = seen.size();
    for (double along = clear_part.first; along <= clear_part.last; along += step) {
      const std::size_t c = lattice.cell_at(start + along * way);
      const Vector3d own = lattice.places[c];
      // The nearest place of this step, so that it is in the cell or just beside it.
      const double nearest = std::clamp(way.dot(own - start), std::max(along - step, clear_part.first),
                                        std::min(along + step, clear_part.last));
      const Vector3d place = start + nearest * way;
      const double distance = (place - own).norm();
      SeenCell& cell = seen[c];
      if (cell.lines == 0 || distance < cell.distance) {
        cell.place = place;
        cell.distance = distance;
      }
      cell.lines += c != before ? 1 : 0;
      before = c;
    }
  }
  return seen;
}

}  // namespace cloud2csg
