#include "raw/solids/lattice_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

const AlignedBox k_box{Vector3d(-1, -2, 0), Vector3d(3, 1, 2)};

TEST(LatticePlaces, HaveOnePlaceInEachCell) {
  const LatticePlaces lattice = stratified(k_box, 500, RandomStream(1, 2, 3));
  EXPECT_EQ(lattice.places.size(), static_cast<std::size_t>(lattice.cells.prod()));
  EXPECT_NEAR(static_cast<double>(lattice.places.size()), 500, 100);
  for (std::size_t c = 0; c < lattice.places.size(); ++c) {
    EXPECT_EQ(lattice.cell_at(lattice.places[c]), c);
    EXPECT_TRUE(k_box.contains(lattice.places[c]));
  }
}

TEST(LatticePlaces, KnowTheCellsThatALineOfSightPasses) {
  const LatticePlaces lattice = stratified(k_box, 2000, RandomStream(4, 5, 6));
  PointCloud cloud;
  const Vector3d point(-0.7, -1.8, 0.3);
  const Vector3d sensor(6, 4, 5);
  cloud.positions.push_back(point);
  cloud.sensor_positions.push_back(sensor);
  const std::vector<std::uint32_t> all{0};
  const double clear = 0.5;
  const std::vector<SeenCell> seen = seen_cells(lattice, cloud, all, clear);
  const Vector3d way = (sensor - point).normalized();
  std::vector<bool> is_passed(seen.size(), false);  // by many places along the line
  for (double along = clear; k_box.contains(point + along * way); along += 1e-3) {
    is_passed[lattice.cell_at(point + along * way)] = true;
  }
  std::size_t passed = 0;
  for (std::size_t c = 0; c < seen.size(); ++c) {
    if (seen[c].lines == 0) continue;
    ++passed;
    EXPECT_EQ(seen[c].lines, 1U);
    EXPECT_TRUE(is_passed[c]);
    const Vector3d offset = seen[c].place - point;
    EXPECT_GE(offset.norm(), clear - 1e-9);
    EXPECT_LT((offset - offset.dot(way) * way).norm(), 1e-9);
    EXPECT_NEAR((seen[c].place - lattice.places[c]).norm(), seen[c].distance, 1e-12);
  }
  // Steps of half an edge miss no more than corners.
  EXPECT_GT(static_cast<double>(passed), 0.7 * static_cast<double>(std::ranges::count(is_passed, true)));
  cloud.sensor_positions.set(0, {1e300, 1e300, 0});  // its distance is no number
  for (const SeenCell& cell : seen_cells(lattice, cloud, all, clear)) EXPECT_EQ(cell.lines, 0U);
  cloud.sensor_positions = {};
  EXPECT_TRUE(seen_cells(lattice, cloud, all, clear).empty());
}

}  // namespace
}  // namespace cloud2csg
