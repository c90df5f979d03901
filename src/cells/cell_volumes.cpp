#include <algorithm>

#include "cloud2csg/advanced/cells.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_volume_stream = 0x766f6c756d65'73;

Points places_in(const AlignedBox& box, std::size_t count) {
  RandomStream random(0, k_volume_stream);
  Points places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) places.push_back(random_between(box.min(), box.max(), random));
  return places;
}

}  // namespace

CellVolumes measure_volumes(const CellComplex& complex, const PrimitiveSet& primitives, const AlignedBox& box,
                            std::size_t places, const RunContext& run) {
  const Points points = places_in(box, places);
  std::vector<std::vector<std::uint32_t>> inside(primitives.size());  // by primitive: places
  for_each_index(primitives.size(), run, [&](std::size_t p) {
    if (!reach(primitives[p], 0).intersects(box)) return;
    const std::vector<double> distances = signed_distance(primitives[p], points);
    for (std::uint32_t i = 0; i < distances.size(); ++i) {
      if (distances[i] < 0) inside[p].push_back(i);
    }
  });
  std::vector<Cell> cell_of(places);
  for (PrimitiveIndex p = 0; p < inside.size(); ++p) {
    for (const std::uint32_t i : inside[p]) cell_of[i].push_back(p);
  }
  CellVolumes volumes{.of_cell = std::vector<double>(complex.cells.size())};
  const double of_place = box.volume() / static_cast<double>(places);
  for (const Cell& cell : cell_of) {
    const auto found = std::ranges::lower_bound(complex.cells, cell);
    const bool is_known = found != complex.cells.end() && *found == cell;
    (is_known ? volumes.of_cell[static_cast<std::size_t>(found - complex.cells.begin())] : volumes.elsewhere) +=
        of_place;
  }
  return volumes;
}

}  // namespace cloud2csg
