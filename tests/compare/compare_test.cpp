#include "cloud2csg/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/files.hpp"
#include "sample/solids.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

Shape3d model_of(const KnownSolid& solid) {
  return {.model = Model{.primitives = solid.primitives, .tree = solid.tree}};
}
Shape3d model_of(Primitive primitive) {
  return {.model = Model{.primitives = {std::move(primitive)}, .tree = CsgTree::leaf(0)}};
}
Shape3d mesh_of(const Shape3d& shape, int resolution = 64) {
  const Model& model = *shape.model;
  return {.mesh = mesh_surface(model, bounds_of(model), {.resolution = resolution})};
}

/// One point: something to compare with when only the first shape is of interest.
Shape3d one_point() {
  PointCloud cloud;
  cloud.positions.push_back({0, 0, 0});
  return {.cloud = cloud};
}

double volume(const Shape3d& shape) {
  return compare(shape, one_point(), {.surface_samples = 1}).volume_truth.value_or(-1.0);
}

/// A box as twelve triangles.
TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1) != 0 ? high.x() : low.x(), (corner & 2) != 0 ? high.y() : low.y(),
                             (corner & 4) != 0 ? high.z() : low.z()});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

double iou(const Shape3d& truth, const Shape3d& result) {
  const Comparison comparison = compare(truth, result, {.surface_samples = 100});
  EXPECT_TRUE(comparison.intersection_over_union.has_value());
  return comparison.intersection_over_union.value_or(-1.0);
}

TEST(Compare, EqualSolidsAreExactlyEqual) {
  for (const std::vector<KnownSolid>& solids : {plain_solids(), combined_solids(), cut_cubes(), field_solids()}) {
    for (const KnownSolid& solid : solids) {
      const Comparison same = compare(model_of(solid), model_of(solid), {.resolution = 48, .surface_samples = 500});
      EXPECT_EQ(same.intersection_over_union, 1.0) << solid.name;
      EXPECT_LT(same.hausdorff_distance, 1e-7) << solid.name;
      EXPECT_EQ(same.size_ratio, 1.0) << solid.name;
      EXPECT_EQ(same.depth_ratio, 1.0) << solid.name;
    }
  }
}

TEST(Compare, VolumesAreThoseOfClosedForms) {
  for (const std::vector<KnownSolid>& solids : {plain_solids(), combined_solids(), cut_cubes(), field_solids()}) {
    for (const KnownSolid& solid : solids) {
      EXPECT_NEAR(volume(model_of(solid)) / solid.volume, 1.0, 2e-4) << solid.name;
    }
  }
}

TEST(Compare, TellsAThousandthFromNothing) {
  const double side = std::cbrt(0.999);
  EXPECT_NEAR(iou(model_of(at("a", Box{{1, 1, 1}}, {0, 0, 0})), model_of(at("b", Box{{side, side, side}}, {0, 0, 0}))),
              0.999, 2e-4);
  EXPECT_NEAR(iou(model_of(at("a", Sphere{1}, {0, 0, 0})), model_of(at("b", Sphere{side}, {0, 0, 0}))), 0.999, 2e-4);
}

TEST(Compare, ShiftedBoxesHaveTheirKnownOverlap) {
  const Shape3d a = model_of(at("a", Box{{1, 1, 1}}, {0, 0, 0}));
  for (const Eigen::Vector3d& shift : {Eigen::Vector3d(0.1, 0, 0), {0, 1.0 / 3.0, 0}, {0, 0, 0.5}}) {
    const double distance = shift.norm();
    EXPECT_NEAR(iou(a, model_of(at("b", Box{{1, 1, 1}}, shift))), (1 - distance) / (1 + distance), 3e-4) << distance;
  }
  EXPECT_EQ(iou(model_of(at("a", Box{{1, 1, 1}}, {0, 0, 0})), model_of(at("b", Box{{1, 1, 1}}, {3, 0, 0}))), 0.0);
}

TEST(Compare, SlenderSolidsAreMeasuredToo) {
  for (const int axis : {0, 1, 2}) {
    Eigen::Vector3d size = Eigen::Vector3d::Ones();
    size[axis] = 100;
    const Shape3d rod = model_of(at("a", Box{size}, {0, 0, 0}));
    EXPECT_NEAR(volume(rod), 100.0, 0.2) << axis;
  }
}

TEST(Compare, ThinWallsAreNotMissed) {
  // Far thinner than the spacing of the samples along a column.
  const Shape3d sheet = model_of(at("a", Box{{1, 1, 1e-3}}, {0, 0, 0}));
  const Primitive frame = at("b", Box{{1, 1, 1}}, {0, 0, 0});
  const Shape3d both{.model = Model{.primitives = {sheet.model->primitives[0], at("b", Box{{0.1, 0.1, 1}}, {0, 0, 0})},
                                    .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))}};
  const double expected = 1e-3 + 0.01 * (1 - 1e-3);
  EXPECT_NEAR(compare(both, model_of(frame), {.surface_samples = 1}).volume_truth.value_or(0.0), expected,
              0.01 * expected);
}

TEST(Compare, ModelAndMeshAgree) {
  for (const KnownSolid& solid : combined_solids()) {
    const Shape3d model = model_of(solid);
    const Comparison comparison = compare(model, mesh_of(model), {.resolution = 128, .surface_samples = 2000});
    EXPECT_GT(comparison.intersection_over_union.value_or(0.0), 0.998) << solid.name;
    EXPECT_LT(comparison.mean_distance, 1e-3) << solid.name;
    EXPECT_FALSE(comparison.size_ratio.has_value());
    EXPECT_FALSE(comparison.depth_ratio.has_value());
  }
}

TEST(Compare, MeshesOfBoxesAreExact) {
  const Shape3d mesh{.mesh = box_mesh({-1, -1, -1}, {1, 1, 1})};
  const Shape3d model = model_of(at("a", Box{{2, 2, 2}}, {0, 0, 0}));
  const Comparison comparison = compare(mesh, model, {.surface_samples = 2000});
  EXPECT_NEAR(comparison.intersection_over_union.value_or(0.0), 1.0, 1e-9);
  EXPECT_LT(comparison.hausdorff_distance, 1e-9);
  EXPECT_EQ(compare(mesh, mesh, {.surface_samples = 100}).intersection_over_union, 1.0);
}

TEST(Compare, OverlappingShellsOfAMeshCountOnce) {
  TriangleMesh mesh = box_mesh({0, 0, 0}, {2, 1, 1});
  const TriangleMesh second = box_mesh({1, 0.2, 0.2}, {3, 0.8, 0.8});
  for (std::array<std::uint32_t, 3> triangle : second.triangles) {
    for (std::uint32_t& vertex : triangle) vertex += 8;
    mesh.triangles.push_back(triangle);
  }
  for (std::size_t i = 0; i < second.vertices.size(); ++i) mesh.vertices.push_back(second.vertices[i]);
  const Shape3d shape{.mesh = mesh};
  EXPECT_NEAR(volume(shape), 2.36, 1e-3);
}

TEST(Compare, AMeshWithAHoleHasNoVolume) {
  TriangleMesh open = box_mesh({0, 0, 0}, {1, 1, 1});
  open.triangles.erase(open.triangles.begin());
  const Shape3d closed{.mesh = box_mesh({0, 0, 0}, {1, 1, 1})};
  const Comparison comparison = compare(closed, {.mesh = open}, {.surface_samples = 100});
  EXPECT_TRUE(comparison.volume_truth.has_value());
  EXPECT_FALSE(comparison.volume_result.has_value());
  EXPECT_FALSE(comparison.intersection_over_union.has_value());
}

TEST(Compare, ConcentricSpheresAreTheirRadiiApart) {
  const Shape3d small = model_of(at("a", Sphere{1.0}, {0, 0, 0}));
  const Shape3d large = model_of(at("b", Sphere{1.3}, {0, 0, 0}));
  const Comparison models = compare(small, large, {.surface_samples = 5000});
  EXPECT_NEAR(models.mean_distance, 0.3, 1e-9);
  EXPECT_NEAR(models.hausdorff_distance, 0.3, 1e-9);
  EXPECT_NEAR(models.intersection_over_union.value_or(0.0), 1 / std::pow(1.3, 3), 2e-4);
  const Comparison meshes = compare(mesh_of(small), mesh_of(large), {.surface_samples = 5000});
  EXPECT_NEAR(meshes.mean_distance, 0.3, 2e-3);
  EXPECT_NEAR(meshes.hausdorff_distance, 0.3, 5e-3);
}

TEST(Compare, DistancesBesideEdgesAreThoseToTheEdge) {
  // The rim of a hole in a plate: the foot on the plate's own face would lie in the hole.
  const KnownSolid plate{.name = "plate",
                         .primitives = {at("a", Box{{4, 4, 1}}, {0, 0, 0}), at("b", Cylinder{1, 2}, {0, 0, 0})},
                         .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))};
  PointCloud in_the_hole;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), {0.5, 0, 1.5}, {0, -0.8, -0.9}}) {
    in_the_hole.positions.push_back(p);
  }
  const Shape3d axis_points{.cloud = in_the_hole};
  const double expected = (1.0 + std::hypot(0.5, 1.0) + std::hypot(0.2, 0.4)) / 3;
  const Comparison comparison = compare(axis_points, model_of(plate), {.surface_samples = 1});
  // The other side's mean is the distance of the one sample to the nearest of three points: no use here.
  const Comparison back = compare(model_of(plate), axis_points, {.surface_samples = 1});
  EXPECT_DOUBLE_EQ(comparison.mean_distance, back.mean_distance);
  const double sample_to_cloud = 2 * comparison.mean_distance - expected;
  const PointCloud one = sample_surface(plate.model(), {.count = 1});
  double nearest = 1e9;
  for (std::size_t i = 0; i < 3; ++i) {
    nearest = std::min(nearest, (axis_points.cloud->positions[i] - one.positions[0]).norm());
  }
  EXPECT_NEAR(sample_to_cloud, nearest, 2e-3);
}

TEST(Compare, CloudsHaveDistancesOnly) {
  const KnownSolid solid = combined_solids()[0];
  const Shape3d cloud{.cloud = sample_surface(solid.model(), {.count = 20'000, .seed = 9})};
  const Comparison with_model = compare(model_of(solid), cloud, {.surface_samples = 20'000});
  EXPECT_FALSE(with_model.intersection_over_union.has_value());
  EXPECT_TRUE(with_model.volume_truth.has_value());
  EXPECT_FALSE(with_model.volume_result.has_value());
  EXPECT_FALSE(with_model.size_ratio.has_value());
  EXPECT_FALSE(with_model.depth_ratio.has_value());
  EXPECT_LT(with_model.mean_distance, 0.02);
  EXPECT_GT(with_model.mean_distance, 0.0);
  const Comparison itself = compare(cloud, cloud);
  EXPECT_EQ(itself.mean_distance, 0.0);
  EXPECT_FALSE(itself.volume_truth.has_value());
}

TEST(Compare, RatiosAreResultOverTruth) {
  const KnownSolid two = combined_solids()[0];
  const Shape3d single = model_of(at("a", Box{{2, 2, 2}}, {0, 0, 0}));
  EXPECT_EQ(compare(single, model_of(two), {.resolution = 16, .surface_samples = 10}).size_ratio, 3.0);
  EXPECT_FALSE(compare(single, model_of(two), {.resolution = 16, .surface_samples = 10}).depth_ratio.has_value());
  EXPECT_EQ(compare(model_of(two), single, {.resolution = 16, .surface_samples = 10}).depth_ratio, 0.0);
}

TEST(Compare, DoesNotDependOnTheNumberOfThreads) {
  const KnownSolid a = combined_solids()[5];
  const KnownSolid b = combined_solids()[0];
  const Comparison one =
      compare(model_of(a), mesh_of(model_of(b)), {.resolution = 128, .surface_samples = 5000}, {.threads = 1});
  const Comparison all =
      compare(model_of(a), mesh_of(model_of(b)), {.resolution = 128, .surface_samples = 5000}, {.threads = 0});
  EXPECT_EQ(one.intersection_over_union, all.intersection_over_union);
  EXPECT_EQ(one.mean_distance, all.mean_distance);
  EXPECT_EQ(one.hausdorff_distance, all.hausdorff_distance);
}

void expect_refused(const Shape3d& truth, const Shape3d& result, const CompareOptions& options,
                    const std::string& where, const std::string& expected) {
  try {
    (void)compare(truth, result, options);
    FAIL() << "no error: " << expected;
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, where);
    EXPECT_NE(error.parts().expected.find(expected), std::string::npos) << error.what();
  }
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const Shape3d ball = model_of(at("a", Sphere{1}, {0, 0, 0}));
  Shape3d without_tree = ball;
  without_tree.model->tree.reset();
  expect_refused(without_tree, ball, {}, "truth", "no tree");
  expect_refused(ball, {}, {}, "result", "one of");
  expect_refused(ball, {.cloud = PointCloud{}}, {}, "result", "empty");
  expect_refused(ball, {.mesh = TriangleMesh{}}, {}, "result", "empty");
  expect_refused(ball, model_of(at("h", HalfSpace{}, {0, 0, 0})), {}, "tree", "unbounded");
  expect_refused(ball, ball, {.resolution = 1}, "resolution", "2 to 8192");
  expect_refused(ball, ball, {.surface_samples = 0}, "surface_samples", "1 or more");
}

TEST(Compare, HonoursTheStopToken) {
  std::stop_source stop;
  stop.request_stop();
  const Shape3d ball = model_of(at("a", Sphere{1}, {0, 0, 0}));
  EXPECT_THROW((void)compare(ball, ball, {}, {.stop = stop.get_token()}), Cancelled);
}

TEST(ReadShape, GoesByTheEnding) {
  const TemporaryFolder folder;
  const Shape3d ball = model_of(at("a", Sphere{1}, {0, 0, 0}));
  write_model(folder / "a.json", *ball.model);
  write_mesh(folder / "a.STL", box_mesh({0, 0, 0}, {1, 1, 1}));
  write_mesh(folder / "a.off", box_mesh({0, 0, 0}, {1, 1, 1}));
  write_mesh(folder / "a.obj", box_mesh({0, 0, 0}, {1, 1, 1}));
  write_text_file(folder / "cloud.ply",
                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                  "end_header\n1 2 3\n");
  write_text_file(folder / "mesh.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write_text_file(folder / "a.xyz", "1 2 3\n");
  EXPECT_TRUE(read_shape(folder / "a.json").model.has_value());
  for (const char* name : {"a.STL", "a.off", "a.obj"}) {
    const Shape3d shape = read_shape(folder / name);
    ASSERT_TRUE(shape.mesh.has_value()) << name;
    EXPECT_EQ(shape.mesh->triangles.size(), 12U) << name;
  }
  EXPECT_TRUE(read_shape(folder / "mesh.ply").mesh.has_value());
  EXPECT_TRUE(read_shape(folder / "cloud.ply").cloud.has_value());
  EXPECT_TRUE(read_shape(folder / "a.xyz").cloud.has_value());
  EXPECT_THROW((void)read_shape(folder / "a.step"), Error);
  EXPECT_THROW((void)read_shape(folder / "none.ply"), Error);
}

}  // namespace
}  // namespace cloud2csg
