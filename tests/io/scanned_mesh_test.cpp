#include "io/scanned_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "core/base/random.hpp"
#include "support/known_solids.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using testing_support::TemporaryFolder;

/// A plate with a pin, in triangles of about 0.04.
TriangleMesh fine_mesh() {
  const PrimitiveSet solids{test::placed("plate", Box{{2, 1.5, 0.5}}, {0, 0, 0}),
                            test::placed("pin", Cylinder{0.4, 1}, {0, 0, 0.5})};
  const Model model{.primitives = solids, .tree = parse_tree("plate | pin", solids)};
  return mesh_surface(model, bounds_of(model), {.resolution = 48});
}

TriangleMesh with_noise(TriangleMesh mesh, double noise) {
  RandomStream random(1, 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d offset(random.normal(), random.normal(), random.normal());
    mesh.vertices.set(i, mesh.vertices[i] + noise * offset);
  }
  return mesh;
}

/// A torus of radii 1 and 0.05.
TriangleMesh ring(std::uint32_t around, std::uint32_t sides) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double at = 2 * std::numbers::pi * i / around;
      const double turn = 2 * std::numbers::pi * k / sides;
      const double radius = 1 + 0.05 * std::cos(turn);
      mesh.vertices.push_back({radius * std::cos(at), radius * std::sin(at), 0.05 * std::sin(turn)});
      const std::uint32_t next = (i + 1) % around * sides;
      const std::uint32_t other = (k + 1) % sides;
      mesh.triangles.push_back({i * sides + k, next + k, next + other});
      mesh.triangles.push_back({i * sides + k, next + other, i * sides + other});
    }
  }
  return mesh;
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
    mesh.vertices.push_back(corner);
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A mesh with one facet in place of all that have a corner beyond `height`.
TriangleMesh filled_above(const TriangleMesh& mesh, double height) {
  TriangleMesh filled{.vertices = mesh.vertices, .triangles = {}};
  for (const auto& corners : mesh.triangles) {
    const auto is_above = [&](std::uint32_t corner) { return mesh.vertices[corner].z() > height; };
    if (std::ranges::none_of(corners, is_above)) filled.triangles.push_back(corners);
  }
  const auto first = static_cast<std::uint32_t>(filled.vertices.size());
  for (const Vector3d& corner : {Vector3d(-0.3, -0.2, 0.9), Vector3d(0.3, -0.2, 0.9), Vector3d(0, 0.3, 0.9)}) {
    filled.vertices.push_back(corner);
  }
  filled.triangles.push_back({first, first + 1, first + 2});
  return filled;
}

TEST(ScannedPoints, AreTheVerticesOfANoisyMesh) {
  const TriangleMesh mesh = fine_mesh();
  for (const double noise : {0.002, 0.01}) {
    const std::optional<ScannedPoints> scan = scanned_points(with_noise(mesh, noise));
    ASSERT_TRUE(scan.has_value()) << noise;
    EXPECT_EQ(scan->cloud.size(), mesh.vertices.size());
    EXPECT_FALSE(scan->cloud.has_normals());
    EXPECT_NEAR(scan->noise, noise, 0.3 * noise);
  }
}

TEST(ScannedPoints, AreAbsentWithoutNoiseOrWithoutVerticesOnFaces) {
  EXPECT_FALSE(scanned_points(fine_mesh()).has_value());
  // A CAD program cuts a cylinder into long facets between its rims.
  TriangleMesh can;
  constexpr std::uint32_t k_sides = 3000;
  for (std::uint32_t k = 0; k < k_sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / k_sides;
    can.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    can.vertices.push_back({std::cos(angle), std::sin(angle), 1});
    const std::uint32_t next = (k + 1) % k_sides;
    can.triangles.push_back({2 * k, 2 * next, 2 * k + 1});
    can.triangles.push_back({2 * next, 2 * next + 1, 2 * k + 1});
  }
  EXPECT_FALSE(scanned_points(with_noise(can, 0.01)).has_value());
  EXPECT_FALSE(scanned_points({}).has_value());
}

TEST(ScannedPoints, AreAbsentForCoarseFacetsOfThinTubes) {
  for (const std::uint32_t sides : {6U, 10U, 16U}) {
    EXPECT_FALSE(scanned_points(ring(400, sides)).has_value()) << sides;
    EXPECT_TRUE(scanned_points(with_noise(ring(400, sides), 0.01)).has_value()) << sides;
  }
}

TEST(ScannedPoints, AreAbsentWhereVerticesSayNothing) {
  TriangleMesh unused = tetrahedron();
  for (int i = 0; i < 3000; ++i) unused.vertices.push_back({0.1, 0.2, 0.001 * i});
  EXPECT_FALSE(scanned_points(unused).has_value());
  TriangleMesh coincident;
  for (std::uint32_t t = 0; t < 1000; ++t) {
    for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
      coincident.vertices.push_back(corner);
    }
    coincident.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  EXPECT_FALSE(scanned_points(coincident).has_value());
}

TEST(ScannedPoints, CoverFilledHoles) {
  const TriangleMesh mesh = with_noise(filled_above(fine_mesh(), 0.9), 0.005);
  const std::optional<ScannedPoints> scan = scanned_points(mesh);
  ASSERT_TRUE(scan.has_value());
  std::size_t in_hole = 0;
  for (std::size_t i = 0; i < scan->cloud.size(); ++i) {
    const Vector3d place = scan->cloud.positions[i];
    in_hole += std::abs(place.z() - 0.9) < 0.05 && place.head<2>().norm() < 0.15 ? 1U : 0U;
  }
  EXPECT_GT(in_hole, 20U) << "the facet has the area of a hundred others";
}

TEST(ScannedPoints, AreTakenByTheReader) {
  const TemporaryFolder folder;
  write_mesh(folder / "exact.off", fine_mesh());
  const Input exact = read_cloud_or_mesh(folder / "exact.off", {.mesh_points = 500});
  EXPECT_TRUE(exact.is_exact);
  EXPECT_EQ(exact.cloud.size(), 500U);
  EXPECT_FALSE(test::mentions(exact.warnings, "made from a scan"));
  write_mesh(folder / "scan.off", with_noise(fine_mesh(), 0.005));
  const Input scan = read_cloud_or_mesh(folder / "scan.off", {.mesh_points = 500});
  EXPECT_FALSE(scan.is_exact);
  EXPECT_TRUE(scan.mesh.has_value());
  EXPECT_EQ(scan.cloud.size(), fine_mesh().vertices.size());
  EXPECT_TRUE(test::mentions(scan.warnings, "made from a scan"));
  EXPECT_THROW((void)read_cloud_or_mesh(folder / "scan.off", {.mesh_points = 0}), Error);
}

}  // namespace
}  // namespace cloud2csg
