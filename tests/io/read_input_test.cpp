#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "io/meshes/mesh_faults.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using testing_support::TemporaryFolder;

/// The surface of a cube from (0, 0, 0) to (size, size, size), 12 triangles, oriented outward.
TriangleMesh cube(double size = 1.0) {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back(size * Vector3d(i & 1U, i >> 1U & 1U, i >> 2U & 1U));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TriangleMesh both(TriangleMesh mesh, const TriangleMesh& other, const Vector3d& offset) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < other.vertices.size(); ++i) mesh.vertices.push_back(other.vertices[i] + offset);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

/// How many points have a normal that leads away from the middle of the unit cube, along an axis.
std::size_t outward_points(const PointCloud& cloud) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double height = cloud.normals[i].dot(cloud.positions[i] - Vector3d::Constant(0.5));
    count += std::abs(height - 0.5) < 1e-6 ? 1 : 0;
  }
  return count;
}

TEST(SampleMesh, DrawsUniformlyWithNormalsAndTheSameOnAnyNumberOfThreads) {
  const PointCloud cloud = sample_mesh(cube(), {.mesh_points = 12'000});
  EXPECT_EQ(cloud.size(), 12'000U);
  EXPECT_EQ(outward_points(cloud), cloud.size());
  const auto on_top = std::ranges::count_if(cloud.normals.z, [](double z) { return z > 0.5; });
  EXPECT_NEAR(static_cast<double>(on_top), 2000.0, 200.0);
  const PointCloud again = sample_mesh(cube(), {.mesh_points = 12'000}, {.threads = 2});
  EXPECT_EQ(cloud.positions.x, again.positions.x);
  const PointCloud other = sample_mesh(cube(), {.mesh_points = 12'000, .seed = 2});
  EXPECT_NE(cloud.positions.x, other.positions.x);
}

TEST(SampleMesh, RefusesNoPointsAndNoArea) {
  EXPECT_THROW((void)sample_mesh(cube(), {.mesh_points = 0}), Error);
  EXPECT_THROW((void)sample_mesh({}, {}), Error);
}

TEST(MendMesh, LeavesASoundMeshAlone) {
  const MendedMesh mended = mend_mesh(cube());
  EXPECT_TRUE(mended.warnings.empty());
  EXPECT_EQ(mended.mesh.triangles, cube().triangles);
}

TEST(MendMesh, TurnsAMeshThatIsInsideOut) {
  const MendedMesh mended = mend_mesh(turned(cube()));
  EXPECT_TRUE(test::mentions(mended.warnings, "inside out"));
  EXPECT_DOUBLE_EQ(volume_of(mended.mesh), 1.0);
}

TEST(MendMesh, KeepsACavity) {
  const MendedMesh mended = mend_mesh(both(cube(3.0), turned(cube()), Vector3d::Ones()));
  EXPECT_TRUE(mended.warnings.empty());
  EXPECT_DOUBLE_EQ(volume_of(mended.mesh), 26.0);
}

TEST(MendMesh, TellsWhereItIsOpen) {
  TriangleMesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  const MendedMesh mended = mend_mesh(mesh);
  EXPECT_TRUE(test::mentions(mended.warnings, "open: 4 edges"));
  EXPECT_EQ(find_edge_faults(mesh).open.place.z(), 1.0);
}

TEST(MendMesh, TurnsTrianglesThatDisagree) {
  for (std::size_t every = 2; every <= 6; ++every) {
    TriangleMesh mesh = cube();
    for (std::size_t t = 0; t < mesh.triangles.size(); t += every) {
      std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    }
    const MendedMesh mended = mend_mesh(mesh);
    EXPECT_TRUE(test::mentions(mended.warnings, "disagreed with their neighbours")) << every;
    EXPECT_FALSE(test::mentions(mended.warnings, "which side is outside at")) << every;
    EXPECT_DOUBLE_EQ(volume_of(mended.mesh), 1.0) << every;
    EXPECT_TRUE(is_watertight(mended.mesh)) << every;
  }
}

TEST(MendMesh, TurnsPiecesThatAreInsideOut) {
  const MendedMesh crossing = mend_mesh(both(cube(3.0), turned(cube()), {2.5, 1.0, 1.0}));
  EXPECT_TRUE(test::mentions(crossing.warnings, "inside out, but not within others, were turned: 1"));
  EXPECT_DOUBLE_EQ(volume_of(crossing.mesh), 28.0);
  const MendedMesh hollow = mend_mesh(turned(both(cube(3.0), turned(cube()), Vector3d::Ones())));
  EXPECT_DOUBLE_EQ(volume_of(hollow.mesh), 26.0) << "a cavity stays one when all is turned";
}

TEST(MendMesh, LeavesOpenPiecesAsTheyAre) {
  TriangleMesh sheets = cube();
  // No two triangles share an edge any more: each is a piece of no volume.
  TriangleMesh apart;
  for (const auto& corners : sheets.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.vertices.size());
    for (const std::uint32_t corner : corners) apart.vertices.push_back(sheets.vertices[corner]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(mend_mesh(apart).mesh.triangles, apart.triangles);
}

TEST(MendMesh, TellsOfSelfIntersectionsButNotOfTouching) {
  const TriangleMesh crossing = both(cube(), cube(), {0.3, 0.2, 0.6});
  EXPECT_GT(find_self_intersections(crossing).count, 0U);
  EXPECT_TRUE(test::mentions(mend_mesh(crossing).warnings, "intersects itself"));
  EXPECT_EQ(find_self_intersections(both(cube(), cube(), {1.0, 0.0, 0.0})).count, 0U);
  EXPECT_EQ(find_self_intersections(both(cube(), cube(), {0.25, 0.25, 1.0})).count, 0U);
}

TEST(MendMesh, LeavesOutRepeatedAndFlatTriangles) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({1, 0, 2});  // the first one, rotated
  mesh.triangles.push_back({0, 1, 1});
  const MendedMesh mended = mend_mesh(mesh);
  EXPECT_EQ(mended.mesh.triangles, cube().triangles);
  EXPECT_TRUE(test::mentions(mended.warnings, "1 triangles of the mesh have no area"));
  EXPECT_TRUE(test::mentions(mended.warnings, "1 triangles of the mesh have the same corners as others"));
}

TEST(MendMesh, UnderstandsSurfacesGivenFromBothSides) {
  TriangleMesh mesh = cube();
  const auto back = turned(cube()).triangles;
  mesh.triangles.insert(mesh.triangles.end(), back.begin(), back.end());
  EXPECT_EQ(mend_mesh(mesh).mesh.triangles, cube().triangles);
}

TEST(MendMesh, LeavesOutAnInnerWall) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 1, 7});
  mesh.triangles.push_back({0, 7, 1});
  EXPECT_EQ(mend_mesh(mesh).mesh.triangles, cube().triangles);
}

TEST(ReadCloudOrMesh, DrawsPointsFromEachMeshFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.OFF", "a.obj"}) {
    write_mesh(folder / name, cube());
    const Input input = read_cloud_or_mesh(folder / name, {.mesh_points = 500});
    ASSERT_TRUE(input.mesh.has_value()) << name;
    EXPECT_EQ(input.mesh->vertices.size(), 8U) << name;
    EXPECT_EQ(outward_points(input.cloud), 500U) << name;
    EXPECT_TRUE(input.warnings.empty()) << name;
  }
}

/// Corners of a unit cube a million units away, in numbers that fit single precision, and in others.
TEST(ReadCloudOrMesh, WarnsOfMeshesThatAreTooFarAway) {
  const TemporaryFolder folder;
  for (const double distance : {0.0, 100.0, 1e6, 1e6 + 0.1}) {
    std::ofstream text(folder / "far.off");
    const TriangleMesh mesh = cube();
    text << "OFF\n8 12 0\n";
    for (std::size_t i = 0; i < 8; ++i) {
      const Vector3d corner = mesh.vertices[i] + Vector3d::Constant(distance);
      text << fmt::format("{} {} {}\n", corner.x(), corner.y(), corner.z());
    }
    for (const auto& [a, b, c] : mesh.triangles) text << "3 " << a << ' ' << b << ' ' << c << '\n';
    text.close();
    const Input input = read_cloud_or_mesh(folder / "far.off", {.mesh_points = 100});
    EXPECT_EQ(test::mentions(input.warnings, "coordinates have steps of 0.12"), distance == 1e6) << distance;
  }
}

TEST(ReadCloudOrMesh, TellsPlyMeshesFromPlyClouds) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  std::ofstream(folder / "cloud.ply") << head << points;
  std::ofstream(folder / "mesh.ply") << head << "element face 1\nproperty list uchar int vertex_indices\n"
                                     << points << "3 0 1 2\n";
  const Input cloud = read_cloud_or_mesh(folder / "cloud.ply");
  EXPECT_FALSE(cloud.mesh.has_value());
  EXPECT_EQ(cloud.cloud.size(), 3U);
  const Input mesh = read_cloud_or_mesh(folder / "mesh.ply", {.mesh_points = 10});
  EXPECT_TRUE(mesh.mesh.has_value());
  EXPECT_EQ(mesh.cloud.size(), 10U);
  EXPECT_TRUE(test::mentions(mesh.warnings, "open: 3 edges"));
}

/// A .glb with one triangle in a part that is moved by (10, 0, 0).
std::string moved_triangle_glb() {
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[10,0,0]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
      R"("type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFU);
    return bytes;
  };
  const std::array<float, 9> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string data(36, '\0');
  std::memcpy(data.data(), corners.data(), data.size());
  const std::string chunks = word(json.size()) + "JSON" + json + word(data.size()) + std::string("BIN\0", 4) + data;
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

TEST(ReadCloudOrMesh, AppliesTheMotionsOfParts) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.glb", std::ios::binary) << moved_triangle_glb();
  const Input input = read_cloud_or_mesh(folder / "a.glb", {.mesh_points = 10});
  EXPECT_GE(*std::ranges::min_element(input.cloud.positions.x), 10.0);
}

TEST(ReadCloudOrMesh, LeavesInvalidPointsOutAndCountsThem) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz")
      << "1 2 3 0 0 2\nnan 2 3 0 0 1\n4 5 6 0 0 0\n7 8 9 1 0 0\n1 1 inf 0 0 1\n2 2 2 0 1 0\n";
  const Input input = read_cloud_or_mesh(folder / "a.xyz");
  EXPECT_EQ(input.cloud.positions.x, (std::vector<double>{1, 7, 2}));
  EXPECT_EQ(input.cloud.normals.z, (std::vector<double>{1, 0, 0}));
  EXPECT_TRUE(test::mentions(input.warnings, "3 of 6 points are left out"));
}

TEST(ReadCloudOrMesh, LeavesNormalsOutThatAreMostlyInvalid) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz") << "1 2 3 0 0 0\n4 5 6 nan nan nan\n7 8 9 1 0 0\n";
  const Input input = read_cloud_or_mesh(folder / "a.xyz");
  EXPECT_EQ(input.cloud.size(), 3U);
  EXPECT_FALSE(input.cloud.has_normals());
  EXPECT_TRUE(test::mentions(input.warnings, "2 normals"));
}

TEST(ReadCloudOrMesh, RefusesWhatHasNoValidPointsOrAnotherEnding) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.xyz") << "nan 2 3\n";
  std::ofstream(folder / "a.dwg") << "1 2 3\n";
  EXPECT_THROW((void)read_cloud_or_mesh(folder / "a.xyz"), Error);
  EXPECT_THROW((void)read_cloud_or_mesh(folder / "a.dwg"), Error);
  EXPECT_THROW((void)read_cloud_or_mesh(folder / "missing.stl"), Error);
}

}  // namespace
}  // namespace cloud2csg
