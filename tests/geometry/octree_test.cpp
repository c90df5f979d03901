#include "core/geometry/octree.hpp"

#include <gtest/gtest.h>

namespace cloud2csg {
namespace {

AlignedBox box_of(const OctreeLevel& cells, std::size_t i) {
  return {cells.centres[i] - cells.half_size, cells.centres[i] + cells.half_size};
}

/// Whether the cells fill the box, side by side.
void expect_parts(const OctreeLevel& cells, const AlignedBox& box) {
  AlignedBox all;
  for (std::size_t i = 0; i < cells.centres.size(); ++i) {
    all.extend(box_of(cells, i));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NEAR(box_of(cells, i).intersection(box_of(cells, j)).sizes().cwiseMax(0).prod(), 0, 1e-12);
    }
  }
  EXPECT_TRUE(all.isApprox(box, 1e-12));
  EXPECT_NEAR(static_cast<double>(cells.centres.size()) * cells.volume(), box.volume(), 1e-12 * box.volume());
}

TEST(Octree, ALatticeFillsItsBox) {
  const AlignedBox box(Eigen::Vector3d(-1, 2, 5), Eigen::Vector3d(2, 2.5, 9));
  const OctreeLevel cells = lattice(box, {3, 1, 4});
  EXPECT_EQ(cells.centres.size(), 12U);
  expect_parts(cells, box);
  EXPECT_NEAR(cells.radius(), Eigen::Vector3d(0.5, 0.25, 0.5).norm(), 1e-15);
}

TEST(Octree, HalvesFillTheSameBox) {
  const AlignedBox box(Eigen::Vector3d(-1, 2, 5), Eigen::Vector3d(2, 2.5, 9));
  OctreeLevel cells = lattice(box, {1, 1, 2});
  for (const int axis : {0, 2, 1}) {
    const double size = cells.half_size[axis];
    cells = halved(cells, axis);
    EXPECT_EQ(cells.half_size[axis], size / 2);
    expect_parts(cells, box);
  }
  EXPECT_EQ(cells.centres.size(), 16U);
}

TEST(Octree, OctantsAreHalvesOfHalvesOfHalves) {
  const AlignedBox box(Eigen::Vector3d(-1, -2, -4), Eigen::Vector3d(1, 2, 4));
  const OctreeLevel cells = octants(lattice(box, {1, 1, 1}));
  expect_parts(cells, box);
  ASSERT_EQ(cells.centres.size(), 8U);
  EXPECT_EQ(cells.centres[0], Eigen::Vector3d(-0.5, -1, -2));
  EXPECT_EQ(cells.centres[1], Eigen::Vector3d(0.5, -1, -2));
  EXPECT_EQ(cells.centres[4], Eigen::Vector3d(-0.5, -1, 2));
}

}  // namespace
}  // namespace cloud2csg
