#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "mesh/shapes.hpp"

namespace cloud2csg {
namespace {

using shapes::any_primitive;
using shapes::any_tree;
using shapes::at;
using shapes::euler_characteristic;
using shapes::mesh_of;

constexpr double k_pi = std::numbers::pi;
// Not {}: an Eigen vector made so has no value.
const Eigen::Vector3d k_origin = Eigen::Vector3d::Zero();

AlignedBox cube(double half_size) {
  return {Eigen::Vector3d::Constant(-half_size), Eigen::Vector3d::Constant(half_size)};
}

struct Known {
  const char* name;
  Primitive primitive;
  double volume;
  double tolerance;  ///< relative
  int euler;
};

std::string name_of(const testing::TestParamInfo<Known>& known) {
  return known.param.name;
}
void PrintTo(const Known& known, std::ostream* out) {
  *out << known.name;
}  // NOLINT: GoogleTest's name

class KnownSolid : public testing::TestWithParam<Known> {};

TEST_P(KnownSolid, HasItsVolumeAndTopology) {
  const TriangleMesh mesh = mesh_of(GetParam().primitive);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh) / GetParam().volume, 1.0, GetParam().tolerance);
  EXPECT_EQ(euler_characteristic(mesh), GetParam().euler);
}

INSTANTIATE_TEST_SUITE_P(
    Solids, KnownSolid,
    testing::Values(
        Known{"Box", at(Box{.size = {1, 0.5, 0.3}}, {5, 6, 7}), 0.15, 1e-9, 2},
        Known{"TurnedBox", at(Box{.size = {1, 0.5, 0.3}}, k_origin, {1, 0.3, 0.2, 0.4}), 0.15, 1e-4, 2},
        Known{"Sphere", at(Sphere{.radius = 2}), 4.0 / 3.0 * k_pi * 8, 3e-3, 2},
        Known{"Cylinder", at(Cylinder{.radius = 1, .height = 2}, k_origin, {1, 0.3, 0.2, 0.4}), 2 * k_pi, 3e-3, 2},
        Known{"Cone", at(Cone{.radius_bottom = 1, .radius_top = 0, .height = 1}), k_pi / 3, 3e-3, 2},
        Known{"Frustum", at(Cone{.radius_bottom = 1, .radius_top = 0.5, .height = 1}), k_pi * 1.75 / 3, 3e-3, 2},
        Known{"Torus", at(Torus{.major_radius = 1, .minor_radius = 0.25}), 2 * k_pi* k_pi / 16, 1e-2, 0},
        Known{"Polytope",
              at(Polytope{
                  .planes = {{{-1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{0, 0, -1}, 0}, {{0.6, 0.8, 0}, 1}, {{0, 0, 1}, 1}}}),
              0.5 / 0.48, 1e-4, 2},
        Known{"Expression", at(Expression{.distance = "x^2 + y^2 + z^2 - 1", .bounds = cube(1)}), 4.0 / 3.0 * k_pi,
              3e-3, 2}),
    name_of);

double distance_to_nearest_vertex(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) nearest = std::min(nearest, (mesh.vertices[i] - point).norm());
  return nearest;
}

RC_GTEST_PROP(MeshSurface, CornersOfTurnedBoxesAreVertices, ()) {
  const Eigen::Vector3d size = test::any_vector(0.3, 1);
  const Pose pose = test::any_pose(1);
  const Primitive box = at(Box{.size = size}, pose.position, pose.orientation);
  const TriangleMesh mesh = mesh_of(box, 48);
  RC_ASSERT(is_watertight(mesh));
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) - 0.5, ((corner >> 1) & 1) - 0.5, (corner >> 2) - 0.5);
    RC_ASSERT(distance_to_nearest_vertex(mesh, box.pose.to_world(sign.cwiseProduct(size))) < 1e-3);
  }
}

TEST(MeshSurface, KeepsSharpEdgesWhereCurvedFacesMeet) {
  const TriangleMesh mesh = mesh_of(at(Cylinder{.radius = 0.5, .height = 1}));
  double farthest = 0;
  for (int i = 0; i < 360; ++i) {
    const double angle = i * k_pi / 180;
    const Eigen::Vector3d on_rim(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.5);
    // Vertices are at most about a cell apart along the rim; none of its points is farther from the nearest.
    farthest = std::max(farthest, distance_to_nearest_vertex(mesh, on_rim));
  }
  EXPECT_LT(farthest, 1.0 / 64);
  for (const double z : mesh.vertices.z) EXPECT_LE(std::abs(z), 0.5 + 1e-6);
}

TEST(MeshSurface, VerticesLieOnTheSurface) {
  const PrimitiveSet primitives{at(Sphere{.radius = 0.5}), at(Torus{.major_radius = 0.5, .minor_radius = 0.2}),
                                at(Cylinder{.radius = 0.2, .height = 3})};
  const CsgTree tree = subtract(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  const TriangleMesh mesh = mesh_of(tree, primitives);
  ASSERT_TRUE(is_watertight(mesh));
  for (const double value : implicit_value(tree, primitives, mesh.vertices)) EXPECT_LT(std::abs(value), 0.1 * 1.4 / 64);
}

TEST(MeshSurface, CombinesSolids) {
  const PrimitiveSet primitives{at(Box{.size = {1, 1, 1}}), at(Cylinder{.radius = 0.25, .height = 2})};
  const CsgTree box = CsgTree::leaf(0);
  const CsgTree cylinder = CsgTree::leaf(1);
  const double hole = k_pi / 16;
  const TriangleMesh drilled = mesh_of(subtract(box, cylinder), primitives);
  EXPECT_NEAR(volume_of(drilled), 1 - hole, 1e-3);
  EXPECT_EQ(euler_characteristic(drilled), 0);
  EXPECT_NEAR(volume_of(mesh_of(intersect(box, cylinder), primitives)), hole, 1e-3);
  EXPECT_NEAR(volume_of(mesh_of(unite(box, cylinder), primitives)), 1 + hole, 3e-3);
}

TEST(MeshSurface, ThinWallsSurvive) {
  constexpr double k_wall = 2.0 / 64;  // two cells
  const PrimitiveSet primitives{at(Box{.size = {1, 1, 1}}), at(Box{.size = Eigen::Vector3d::Constant(1 - 2 * k_wall)})};
  const TriangleMesh shell = mesh_of(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), primitives);
  EXPECT_TRUE(is_watertight(shell));
  EXPECT_EQ(euler_characteristic(shell), 4) << "an outer and an inner surface";
  EXPECT_NEAR(volume_of(shell), 1 - std::pow(1 - 2 * k_wall, 3), 1e-9);
}

TEST(MeshSurface, SolidsThatTouchStayClosed) {
  // Along an edge, and in a point: neither is a 2-manifold, so the mesh must choose.
  const PrimitiveSet primitives{at(Box{.size = {1, 1, 1}}, {0.5, 0.5, 0.5}),
                                at(Box{.size = {1, 1, 1}}, {-0.5, -0.5, 0.3}),
                                at(Box{.size = {1, 1, 1}}, {1.5, -0.5, -0.5})};
  const CsgTree tree = unite(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  for (int resolution = 8; resolution < 40; ++resolution) {
    EXPECT_TRUE(is_watertight(mesh_of(tree, primitives, resolution))) << resolution;
  }
}

TEST(MeshSurface, DetailFarBelowTheGridStaysClosed) {
  // Signs that are as good as random: every configuration of cells and faces, next to every other.
  Primitive rough = at(Sphere{.radius = 0.5}, k_origin, {1, 0.3, 0.2, 0.4});
  rough.displacement = Displacement{.frequency = 97};
  for (int resolution = 16; resolution < 40; resolution += 4) {
    const TriangleMesh mesh = mesh_of(rough, resolution);
    ASSERT_GT(mesh.triangles.size(), 1000U);
    EXPECT_TRUE(is_watertight(mesh)) << resolution;
  }
}

std::ptrdiff_t folded_triangles(const TriangleMesh& mesh, const CsgTree& tree, const PrimitiveSet& primitives) {
  Points centroids;
  std::vector<Eigen::Vector3d> normals;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d corner = mesh.vertices[a];
    centroids.push_back((corner + mesh.vertices[b] + mesh.vertices[c]) / 3);
    normals.push_back((mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner));
  }
  const Points gradients = implicit_gradient(tree, primitives, centroids);
  std::size_t i = 0;
  return std::count_if(normals.begin(), normals.end(),
                       [&](const Eigen::Vector3d& normal) { return normal.dot(gradients[i++]) < 0; });
}

TEST(MeshSurface, WithoutCornersFirstNoTriangleLooksTheWrongWay) {
  const Model model = read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / "m2.json");
  const AlignedBox bounds = bounds_of(model);
  const auto folded = [&](bool corners_first) {
    const TriangleMesh mesh = mesh_surface(model, bounds, {.resolution = 32, .corners_first = corners_first});
    EXPECT_TRUE(is_watertight(mesh));
    return folded_triangles(mesh, *model.tree, model.primitives);
  };
  EXPECT_EQ(folded(false), 0);
  EXPECT_LT(folded(true), 20) << "of 6600, around the corners where four spheres meet";
}

TEST(MeshSurface, CutsUnboundedSolidsAtTheBounds) {
  const PrimitiveSet primitives{at(HalfSpace{}, {0, 0, 0.25})};
  const TriangleMesh mesh =
      mesh_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, cube(1), {.resolution = 32});
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 4 * 1.25, 1e-9);
  EXPECT_NEAR(volume_of(mesh_surface({.primitives = primitives, .tree = CsgTree::full()}, cube(1), {.resolution = 32})),
              8, 1e-9);
}

TEST(MeshSurface, CutsBoundedSolidsAtTheBounds) {
  const PrimitiveSet primitives{at(Sphere{.radius = 1})};
  const AlignedBox half(Eigen::Vector3d(-2, -2, 0), Eigen::Vector3d(2, 2, 2));
  const TriangleMesh mesh = mesh_surface({.primitives = primitives, .tree = CsgTree::leaf(0)}, half);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 2.0 / 3.0 * k_pi, 2e-3);
}

TEST(MeshSurface, AnEmptySolidHasNoTriangles) {
  const PrimitiveSet primitives{at(Sphere{.radius = 1}), at(Sphere{.radius = 2}), at(Sphere{.radius = 1}, {9, 0, 0})};
  EXPECT_TRUE(mesh_of(CsgTree::empty(), primitives).triangles.empty());
  EXPECT_TRUE(mesh_of(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), primitives).triangles.empty());
  EXPECT_TRUE(mesh_of(intersect(CsgTree::leaf(0), CsgTree::leaf(2)), primitives).triangles.empty());
}

TEST(MeshSurface, RefusesWhatHasNoBoundsOrNoResolution) {
  const PrimitiveSet primitives{at(HalfSpace{}), at(Sphere{.radius = 1})};
  EXPECT_THROW((void)mesh_of(CsgTree::leaf(0), primitives), Error);
  EXPECT_THROW((void)mesh_of(CsgTree::leaf(1), primitives, 0), Error);
}

TEST(MeshSurface, FarFromTheOriginIsAsGood) {
  const TriangleMesh mesh = mesh_of(at(Box{.size = {1, 1, 1}}, {1000, 2000, 3000}, {1, 0.3, 0.2, 0.4}), 32);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 1, 1e-3);
}

TEST(MeshSurface, ThreadsDoNotChangeTheMesh) {
  const Model model = read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / "m3.json");
  const AlignedBox bounds = bounds_of(model);
  const auto mesh_with = [&](int threads) {
    return mesh_surface(model, bounds, {.resolution = 48}, {.threads = threads});
  };
  const TriangleMesh one = mesh_with(1);
  const TriangleMesh three = mesh_with(3);
  EXPECT_EQ(one.vertices.x, three.vertices.x);
  EXPECT_EQ(one.vertices.z, three.vertices.z);
  EXPECT_EQ(one.triangles, three.triangles);
}

TEST(MeshSurface, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)mesh_surface({.primitives = {at(Sphere{.radius = 1})}, .tree = CsgTree::leaf(0)}, cube(1), {},
                                  {.stop = stop.get_token()}),
               Cancelled);
}

RC_GTEST_PROP(MeshSurface, EveryTreeIsWatertightAndHasItsVolume, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 6);
  PrimitiveSet primitives;
  for (std::size_t i = 0; i < count; ++i) primitives.push_back(any_primitive());
  const CsgTree tree = any_tree(count);
  const AlignedBox bounds = cube(1.2);
  const TriangleMesh mesh = mesh_surface({.primitives = primitives, .tree = tree}, bounds, {.resolution = 40});
  RC_ASSERT(is_watertight(mesh));

  // The volume once more, by counting points spread evenly (Roberts' sequence, which no face is parallel to).
  constexpr int k_points = 64'000;
  const Eigen::Array3d step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  Points points;
  for (int i = 0; i < k_points; ++i) {
    const Eigen::Array3d part = i * step;
    points.push_back(bounds.min().array() + bounds.sizes().array() * (part - part.floor()));
  }
  const std::vector<double> values = implicit_value(tree, primitives, points);
  const auto inside = std::count_if(values.begin(), values.end(), [](double value) { return value < 0; });
  const double counted = bounds.volume() * static_cast<double>(inside) / static_cast<double>(values.size());
  RC_ASSERT(std::abs(volume_of(mesh) - counted) < 0.02 * bounds.volume());
}

}  // namespace
}  // namespace cloud2csg
