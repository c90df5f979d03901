#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cells/surface_samples.hpp"
#include "cloud2csg/advanced/cells.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

/// A few points, so that there are bounds, and many samples.
CellComplex cells_of(const PrimitiveSet& primitives, std::size_t samples) {
  const PointCloud cloud =
      sample_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.count = 50, .seed = 1});
  constexpr double k_small_noise = 0.0005;
  return find_cells(cloud, primitives,
                    {.tolerances = segmentation_tolerances({}, k_small_noise),
                     .noise = k_small_noise,
                     .samples = {.base = samples, .a_neighbour = 0, .most = samples}});
}

/// Of the patch between two cells; 0 where there is none.
double area_between(const CellComplex& complex, const Cell& a, const Cell& b) {
  for (const Patch& patch : complex.patches) {
    const Cell& first = complex.cells[patch.first];
    const Cell& second = complex.cells[patch.second];
    if ((first == a && second == b) || (first == b && second == a)) return patch.area;
  }
  return 0;
}

TEST(PatchAreas, OfOneSolidAreItsSurface) {
  EXPECT_NEAR(area_between(cells_of({test::placed("a", Sphere{2}, {0, 0, 0})}, 100), {}, {0}), 16 * std::numbers::pi,
              1e-9);
  EXPECT_NEAR(area_between(cells_of({test::placed("a", Box{{1, 2, 3}}, {5, 0, 0})}, 100), {}, {0}), 22, 1e-9);
}

/// A corner of each box is in the other.
TEST(PatchAreas, OfTwoBoxesAreThoseOfTheirParts) {
  const CellComplex complex =
      cells_of({test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}), test::placed("b", Box{{2, 2, 2}}, {1, 1, 1})}, 10'000);
  EXPECT_EQ(complex.cells, (std::vector<Cell>{{}, {0}, {0, 1}, {1}}));
  EXPECT_EQ(complex.patches.size(), 4U);
  EXPECT_NEAR(area_between(complex, {}, {0}), 21, 0.4);
  EXPECT_NEAR(area_between(complex, {}, {1}), 21, 0.4);
  EXPECT_NEAR(area_between(complex, {1}, {0, 1}), 3, 0.2);
  EXPECT_NEAR(area_between(complex, {0}, {0, 1}), 3, 0.2);
}

/// Two boxes side by side: where they touch, one step leads from one into the other.
TEST(PatchAreas, AreCountedOnceWhereFacesCoincide) {
  const CellComplex complex =
      cells_of({test::placed("a", Box{{1, 1, 1}}, {0, 0, 0}), test::placed("b", Box{{1, 1, 1}}, {1, 0, 0})}, 5'000);
  EXPECT_EQ(complex.cells, (std::vector<Cell>{{}, {0}, {1}}));
  EXPECT_NEAR(area_between(complex, {0}, {1}), 1, 0.1);
  EXPECT_NEAR(area_between(complex, {}, {0}), 5, 0.2);
  EXPECT_NEAR(area_between(complex, {}, {1}), 5, 0.2);
}

/// Of three boxes that are the same, only together one is in or out.
TEST(PatchAreas, AreCountedOnceForCopies) {
  const Primitive box = test::placed("a", Box{{1, 2, 3}}, {0, 0, 0});
  const CellComplex complex = cells_of({box, box, box}, 1000);
  EXPECT_EQ(complex.cells, (std::vector<Cell>{{}, {0, 1, 2}}));
  EXPECT_NEAR(area_between(complex, {}, {0, 1, 2}), 22, 1e-9);
}

/// Points of a lattice of lines along an axis, and what surface each of their crossings stands for: with the square of
/// the normal's component as a weight, the three axes together see each piece of a surface once (and no division).
double area_by_lines(const Primitive& primitive) {
  constexpr int k_lines = 60;
  const AlignedBox box = bounds(primitive);
  const Eigen::Vector3d step = box.sizes() / k_lines;
  const Points lattice = test::lattice(box, k_lines);
  const std::vector<double> distances = signed_distance(primitive, lattice);
  const std::array<std::size_t, 3> stride{k_lines * k_lines, k_lines, 1};
  double area = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<Eigen::Index>(axis);
    const double of_a_line = 1.04 * 1.04 * step.prod() / step[along];
    Points crossings;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (i / stride[axis] % k_lines + 1 == k_lines) continue;
      const std::size_t next = i + stride[axis];
      if ((distances[i] < 0) == (distances[next] < 0)) continue;
      const double share = distances[i] / (distances[i] - distances[next]);
      crossings.push_back(lattice[i] + share * (lattice[next] - lattice[i]));
    }
    const Points slopes = gradient(primitive, crossings);
    for (std::size_t i = 0; i < slopes.size(); ++i) area += of_a_line * std::abs(slopes[i].normalized()[along]);
  }
  return area;
}

SurfaceSamples samples_of(const Primitive& primitive, const AlignedBox& region, std::size_t count) {
  return sample_surfaces({primitive}, std::vector{reach(primitive, 0)}, region,
                         {.base = count, .a_neighbour = 0, .most = count});
}

/// Also of fields that are no distance.
TEST(PatchAreas, OfExpressionsAndDisplacedSolidsAreNearlyRight) {
  const AlignedBox around(Eigen::Vector3d::Constant(-1.5), Eigen::Vector3d::Constant(1.5));
  PrimitiveSet primitives{test::placed("ball", Expression{"sqrt(x^2 + y^2 + z^2) - 1", around}, {0, 0, 0}),
                          test::placed("square", Expression{"x^2 + y^2 + z^2 - 1", around}, {1, 2, 3}),
                          test::placed("egg", Expression{"sqrt(x^2 + (y / 1.4)^2 + (2 * z)^2) - 1", around}, {0, 0, 0}),
                          test::placed("stone", Sphere{3}, {0, 0, 0}), test::placed("slab", Box{{8, 4, 6}}, {0, 0, 0})};
  primitives[3].displacement = Displacement{.frequency = 1};
  primitives[4].displacement = Displacement{.frequency = 0.7};
  for (const Primitive& primitive : primitives) {
    const SurfaceSamples samples = samples_of(primitive, bounds(primitive), 2000);
    const double area = samples.area_of_sample[0] * static_cast<double>(samples.points.size());
    const double expected = area_by_lines(primitive);
    EXPECT_NEAR(area, expected, 0.15 * expected) << primitive.id;
  }
  EXPECT_NEAR(area_by_lines(primitives[0]), 4 * std::numbers::pi, 0.1);
}

TEST(SurfaceSamples, AreOnTheirSurfacesWithTheirNormals) {
  RandomStream random(3);
  const AlignedBox region(Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2));
  for (int i = 0; i < 40; ++i) {
    const Primitive primitive = test::random_primitive(random);
    const SurfaceSamples samples = samples_of(primitive, region, 100);
    const std::vector<double> distances = signed_distance(primitive, samples.points.positions);
    ASSERT_EQ(samples.points.normals.size(), distances.size());
    EXPECT_GT(samples.area_of_sample[0], 0.0);
    EXPECT_GE(distances.size(), 90U) << type_name(primitive.shape);
    for (std::size_t k = 0; k < distances.size(); ++k) {
      EXPECT_NEAR(distances[k], 0, 1e-4) << type_name(primitive.shape);
      EXPECT_NEAR(samples.points.normals[k].norm(), 1, 1e-9);
    }
  }
}

TEST(SurfaceSamples, OfHalfSpacesCoverTheRegion) {
  const AlignedBox region(Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(3, 2, 1));
  const SurfaceSamples samples = samples_of(test::placed("a", HalfSpace{}, {0, 0, 0}), region, 200);
  AlignedBox box;
  for (std::size_t i = 0; i < samples.points.size(); ++i) box.extend(samples.points.positions[i]);
  EXPECT_LT(box.min().x(), 0.3);
  EXPECT_GT(box.max().x(), 2.7);
  EXPECT_NEAR(box.sizes().z(), 0, 1e-12);
}

}  // namespace
}  // namespace cloud2csg
