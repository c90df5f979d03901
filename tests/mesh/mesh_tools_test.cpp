#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/base/files.hpp"
#include "mesh/shapes.hpp"
#include "shape/mesh/cell_topology.hpp"

namespace cloud2csg {
namespace {

using shapes::at;
using shapes::mesh_of;
using shapes::temporary;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  mesh.vertices.push_back({1, 0, 0});
  mesh.vertices.push_back({0, 1, 0});
  mesh.vertices.push_back({0, 0, 1});
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

TEST(IsWatertight, SeesHolesFlipsAndDoubles) {
  EXPECT_TRUE(is_watertight(tetrahedron()));
  EXPECT_TRUE(is_watertight({}));
  TriangleMesh hole = tetrahedron();
  hole.triangles.pop_back();
  EXPECT_FALSE(is_watertight(hole));
  TriangleMesh flipped = tetrahedron();
  std::swap(flipped.triangles[0][1], flipped.triangles[0][2]);
  EXPECT_FALSE(is_watertight(flipped));
  TriangleMesh doubled = tetrahedron();
  doubled.triangles.insert(doubled.triangles.end(), doubled.triangles.begin(), doubled.triangles.begin() + 4);
  EXPECT_FALSE(is_watertight(doubled));
  TriangleMesh collapsed = tetrahedron();
  collapsed.triangles.push_back({0, 0, 1});
  EXPECT_FALSE(is_watertight(collapsed));
}

TEST(VolumeOf, IsPositiveForOutwardTriangles) {
  TriangleMesh mesh = tetrahedron();
  EXPECT_DOUBLE_EQ(volume_of(mesh), 1.0 / 6.0);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_DOUBLE_EQ(volume_of(mesh), -1.0 / 6.0);
}

TEST(BoundsOfTree, FollowsTheFormula) {
  const PrimitiveSet primitives{at(Sphere{.radius = 1}), at(Sphere{.radius = 1}, {1, 0, 0}), at(HalfSpace{}),
                                at(Sphere{.radius = 1}, {9, 0, 0})};
  const CsgTree a = CsgTree::leaf(0);
  const CsgTree b = CsgTree::leaf(1);
  const CsgTree half_space = CsgTree::leaf(2);
  const auto x_range = [&](const CsgTree& tree) {
    const AlignedBox box = bounds_of({.primitives = primitives, .tree = tree});
    return std::pair(box.min().x(), box.max().x());
  };
  EXPECT_EQ(x_range(unite(a, b)), std::pair(-1.0, 2.0));
  EXPECT_EQ(x_range(intersect(a, b)), std::pair(0.0, 1.0));
  EXPECT_EQ(x_range(subtract(a, b)), std::pair(-1.0, 1.0));
  EXPECT_EQ(x_range(intersect(a, half_space)), std::pair(-1.0, 1.0));
  EXPECT_EQ(x_range(complement(unite(complement(a), complement(b)))), std::pair(0.0, 1.0));
  EXPECT_EQ(x_range(subtract(a, complement(b))), std::pair(0.0, 1.0));
  EXPECT_EQ(x_range(unite(a, CsgTree::empty())), std::pair(-1.0, 1.0));
  EXPECT_EQ(x_range(unite(b, intersect(a, CsgTree::leaf(3)))), std::pair(0.0, 2.0));
  EXPECT_TRUE(std::isinf(x_range(complement(a)).second));
  EXPECT_TRUE(bounds_of({.primitives = primitives, .tree = intersect(a, CsgTree::leaf(3))}).isEmpty());
  EXPECT_TRUE(bounds_of({.primitives = primitives, .tree = CsgTree::empty()}).isEmpty());
}

TEST(CellTopology, EverySheetIsAClosedLoopForAllSignsAndJoins) {
  for (int signs = 0; signs < 256; ++signs) {
    for (int joined = 0; joined < 64; ++joined) {
      const Loops loops = loops_of(static_cast<CornerSigns>(signs), static_cast<FaceMask>(joined));
      int all = 0;
      for (int i = 0; i < loops.count; ++i) {
        const EdgeMask loop = loops.edges[static_cast<std::size_t>(i)];
        EXPECT_EQ(all & loop, 0);
        EXPECT_GE(std::popcount(loop), 3) << "signs " << signs;
        all |= loop;
        // A closed loop crosses each face an even number of times.
        for (int face = 0; face < 6; ++face)
          EXPECT_EQ(std::popcount(static_cast<EdgeMask>(loop & edges_of(face_of(face)))) % 2, 0);
      }
      EXPECT_EQ(all, crossed_edges(static_cast<CornerSigns>(signs)));
    }
  }
}

class Format : public testing::TestWithParam<const char*> {};

TEST_P(Format, ComesBackAsItWas) {
  const TriangleMesh mesh = mesh_of(at(Cylinder{.radius = 0.5, .height = 1}, {0.1, 0.2, 0.3}, {1, 0.2, 0.1, 0.3}), 24);
  const std::filesystem::path file = temporary(GetParam());
  write_mesh(file, mesh);
  const TriangleMesh again = read_mesh(file);
  std::filesystem::remove(file);
  EXPECT_EQ(again.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(again.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(is_watertight(again));
  EXPECT_NEAR(volume_of(again), volume_of(mesh), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Formats, Format, testing::Values("copy.stl", "copy.off", "copy.OBJ"));

TEST(ReadMesh, CutsPolygonsAndJoinsCorners) {
  const std::filesystem::path file = temporary("cube.off");
  write_text(file,
             "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
             "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  const TriangleMesh mesh = read_mesh(file);
  std::filesystem::remove(file);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles.size(), 12U);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 1, 1e-12);
}

TEST(ReadMesh, ReadsPly) {
  const std::filesystem::path file = temporary("tetrahedron.ply");
  write_text(file,
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n");
  const TriangleMesh mesh = read_mesh(file);
  std::filesystem::remove(file);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 1.0 / 6.0, 1e-7);
}

TEST(ReadMesh, RefusesWhatIsNoMesh) {
  const auto refused = [](const char* name, const std::string& text) {
    const std::filesystem::path file = temporary(name);
    write_text(file, text);
    try {
      (void)read_mesh(file);
      ADD_FAILURE() << "accepted " << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, file.string());
    }
    std::filesystem::remove(file);
  };
  refused("nonsense.stl", "this is not a mesh");
  refused("nonsense.off", "OFF\nx y z\n");
  refused("empty.obj", "");
  refused("only_points.obj", "v 0 0 0\nv 1 0 0\n");
  refused("only_points.ply",
          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
          "end_header\n0 0 0\n");
  refused("mesh.docx", "OFF\n");
  EXPECT_THROW((void)read_mesh(temporary("not_there.stl")), Error);
}

TEST(WriteMesh, ComesBackAsItWas) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.set(3, {0.25, -1.5e-3, 1000.5});
  for (const char* name : {"back.stl", "back.off", "back.obj", "back.3mf"}) {
    const std::filesystem::path file = temporary(name);
    write_mesh(file, mesh);
    const TriangleMesh back = read_mesh(file);
    EXPECT_EQ(back.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_TRUE(is_watertight(back)) << name;
    EXPECT_NEAR(volume_of(back), volume_of(mesh), 1e-6 * volume_of(mesh)) << name;
    EXPECT_TRUE(bounds_of(back.vertices).isApprox(bounds_of(mesh.vertices), 1e-6)) << name;
    const std::string bytes = read_text_file(file);
    write_mesh(file, mesh);
    EXPECT_EQ(read_text_file(file), bytes) << name;
    std::filesystem::remove(file);
  }
}

TEST(WriteMesh, RefusesUnknownEndingsAndFolders) {
  EXPECT_THROW(write_mesh(temporary("mesh.fbx"), tetrahedron()), Error);
  EXPECT_THROW(write_mesh(temporary("no_such_folder") / "mesh.stl", tetrahedron()), Error);
}

}  // namespace
}  // namespace cloud2csg
