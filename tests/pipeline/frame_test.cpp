#include "core/geometry/frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

/// Where a cloud lies, and in which units, changes nothing but the numbers.
namespace cloud2csg {
namespace {

/// A tilted bracket: boxes, a bore, a ball and a cone.
Model bracket() {
  Model model{.primitives = {test::placed("base", Box{{3, 2, 0.5}}, {0, 0, 0}),
                             test::placed("wall", Box{{0.5, 2, 1.6}}, {-1.25, 0, 0.8}),
                             test::placed("ball", Sphere{.radius = 0.6}, {1, 0.4, 0.4}),
                             test::placed("bore", Cylinder{.radius = 0.35, .height = 2}, {0, -0.3, 0})},
              .tree = {}};
  model.tree = subtract(unite_all(std::vector{CsgTree::leaf(0), CsgTree::leaf(1), CsgTree::leaf(2)}), CsgTree::leaf(3));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  for (Primitive& primitive : model.primitives) {
    primitive.pose.position = turn * primitive.pose.position;
    primitive.pose.orientation = turn * primitive.pose.orientation;
  }
  return model;
}

struct Motion {
  double unit;
  Eigen::Vector3d shift;
};

/// Units from 1e-9 to 1e9, shifts up to 1e9 diagonals.
std::vector<Motion> motions(double diagonal) {
  RandomStream random(11);
  std::vector<Motion> list;
  for (const double power : {-9.0, -3.5, 0.0, 2.0, 9.0}) {
    for (const double shift_power : {5.0, 9.0}) {
      const double unit = std::pow(10, power);
      list.push_back({unit, unit * diagonal * std::pow(10, shift_power) * test::random_direction(random)});
    }
  }
  return list;
}

PointCloud moved(const PointCloud& cloud, const Motion& motion) {
  PointCloud result = cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    result.positions.set(i, motion.unit * cloud.positions[i] + motion.shift);
  }
  return result;
}

/// Positions and volumes agree to 1e-6 of the diagonal and what the coordinates leave.
void expect_moved(const Extraction& here, const Extraction& there, const Motion& motion, double diagonal) {
  ASSERT_EQ(there.tree(), here.tree()) << motion.unit << " " << motion.shift.transpose();
  const double tolerance = 1e-6 * motion.unit * diagonal + 4 * 2.3e-16 * motion.shift.norm();
  for (std::size_t k = 0; k < here.model.primitives.size(); ++k) {
    const Primitive& one = here.model.primitives[k];
    const Primitive& other = there.model.primitives[k];
    EXPECT_EQ(one.id, other.id);
    const Eigen::Vector3d expected = motion.unit * one.pose.position + motion.shift;
    EXPECT_LT((other.pose.position - expected).norm(), tolerance) << one.id << " " << motion.unit;
    EXPECT_LT(one.pose.orientation.angularDistance(other.pose.orientation), 1e-6 + tolerance / motion.unit) << one.id;
    const Eigen::Vector3d size = bounds(one).sizes() * motion.unit;
    EXPECT_LT((bounds(other).sizes() - size).norm(), 4 * tolerance) << one.id;
  }
}

TEST(FrameOrigin, MovesThereAndBackWithoutRounding) {
  RandomStream random(3);
  for (int trial = 0; trial < 100; ++trial) {
    PointCloud cloud;
    const Eigen::Vector3d middle =
        std::pow(10, random.uniform(1, 9)) * test::random_direction(random) + Eigen::Vector3d::Constant(20);
    for (int i = 0; i < 50; ++i) cloud.positions.push_back(middle + test::random_within(1, random));
    const Eigen::Vector3d origin = frame_origin(cloud.positions);
    const PointCloud near = seen_from(cloud, origin);
    EXPECT_LT(bounds_of(near.positions).center().norm(), 2 * bounds_of(cloud.positions).diagonal().norm());
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(middle[axis]) < 10) continue;  // nearly at zero the points are finer than their frame
      const PointCloud back = seen_from(near, -origin);
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        EXPECT_EQ(back.positions[i][axis], cloud.positions[i][axis]);
      }
    }
  }
}

TEST(FrameOrigin, IsZeroForACloudAboutTheOriginAndWithoutOne) {
  Points points;
  EXPECT_TRUE(frame_origin(points).isZero());
  points.push_back({-1, 2, 0.5});
  points.push_back({1, -1, 0});
  EXPECT_TRUE(frame_origin(points).isZero());
  points.push_back({NAN, 0, 0});
  points.push_back({INFINITY, 0, 0});
  EXPECT_TRUE(frame_origin(points).isZero());
}

TEST(Frame, DoesNotChangeAReconstruction) {
  const PointCloud cloud = sample_surface(bracket(), {.count = 6000, .noise = 0.003, .seed = 2});
  const double diagonal = bounds_of(cloud.positions).diagonal().norm();
  const Extraction here = reconstruct(cloud);
  for (const Motion& motion : motions(diagonal)) {
    const Extraction there = reconstruct(moved(cloud, motion));
    expect_moved(here, there, motion, diagonal);
    EXPECT_EQ(there.statistics.verdict.grade, here.statistics.verdict.grade);
    ASSERT_EQ(there.surfaces.size(), here.surfaces.size());
    const Surface& surface = there.surfaces[0].surface;
    const Points own = select_points(there.cloud, there.surfaces[0].points).positions;
    EXPECT_LT(std::abs(signed_distance(surface, own[0])), 0.1 * motion.unit);
  }
}

/// Blocks from which solids of any type are cut, in any unit and place.
TEST(Frame, DoesNotChangeTheSurfacesOfAnything) {
  RandomStream random(7);
  std::size_t same = 0;
  std::size_t changed = 0;
  for (int trial = 0; trial < 8; ++trial) {
    Model model{.primitives = {test::placed("block", Box{{6, 5, 4}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
    for (PrimitiveIndex p = 1; p <= 3; ++p) {
      Shape shape = test::random_shape(random);
      while (std::holds_alternative<HalfSpace>(shape)) shape = test::random_shape(random);  // cuts off too much
      model.primitives.push_back({.id = std::to_string(p), .shape = std::move(shape)});
      model.primitives.back().pose = test::random_pose(random);
      model.primitives.back().pose.position = test::random_within(3, random);
      model.tree = subtract(*model.tree, CsgTree::leaf(p));
    }
    const PointCloud cloud = sample_surface(model, {.count = 4000, .noise = 0.005, .seed = 2});
    const double diagonal = bounds_of(cloud.positions).diagonal().norm();
    const double unit = std::pow(10, random.uniform(-9, 9));
    const double shift = unit * diagonal * std::pow(10, random.uniform(0, 9));
    const Motion motion{unit, shift * test::random_direction(random)};
    const std::vector<DetectedSurface> here = reconstruct(cloud).surfaces;
    const std::vector<DetectedSurface> there = reconstruct(moved(cloud, motion)).surfaces;
    ASSERT_EQ(there.size(), here.size()) << trial;
    const double tolerance = 1e-6 * unit * diagonal + 4 * 2.3e-16 * shift;
    for (std::size_t k = 0; k < here.size(); ++k) {
      const Surface& one = here[k].surface;
      const Surface& other = there[k].surface;
      const bool is_same = one.type == other.type &&
                           (unit * one.position + motion.shift - other.position).norm() <= tolerance &&
                           one.axis.cross(other.axis).norm() <= tolerance / (unit * diagonal) &&
                           std::abs(unit * one.radius - other.radius) <= tolerance &&
                           std::abs(unit * one.minor_radius - other.minor_radius) <= tolerance &&
                           std::abs(one.half_angle - other.half_angle) <= tolerance / (unit * diagonal);
      ++(is_same ? same : changed);
    }
  }
  EXPECT_GT(same, 80U);
  EXPECT_LE(changed, same / 100) << "rounding decides where two surfaces explain a few points equally well";
}

TEST(Frame, DoesNotChangeAnExtractionOverGivenPrimitives) {
  const Model model = bracket();
  const PointCloud cloud = sample_surface(model, {.count = 6000, .noise = 0.003, .seed = 2});
  const double diagonal = bounds_of(cloud.positions).diagonal().norm();
  const CsgTree here = extract_csg(cloud, model.primitives).tree();
  for (Motion motion : motions(diagonal)) {
    motion.shift /= std::exchange(motion.unit, 1);  // the primitives keep their sizes
    PrimitiveSet there = model.primitives;
    for (Primitive& primitive : there) primitive.pose.position += motion.shift;
    EXPECT_EQ(extract_csg(moved(cloud, motion), there).tree(), here) << motion.shift.transpose();
  }
}

TEST(Frame, DoesNotChangeARefinement) {
  const Model model = bracket();
  const PointCloud cloud = sample_surface(model, {.count = 6000, .noise = 0.003, .seed = 2});
  const double diagonal = bounds_of(cloud.positions).diagonal().norm();
  PrimitiveSet rough = model.primitives;
  rough[0].pose.position.x() += 0.01;
  const Extraction here = extract_refined_csg(cloud, rough);
  ASSERT_TRUE(here.statistics.refine->is_taken);
  for (const double power : {4.0, 9.0}) {
    const Motion motion{.unit = 1, .shift = std::pow(10, power) * diagonal * Eigen::Vector3d(0.6, -0.64, 0.48)};
    PrimitiveSet there = rough;
    for (Primitive& primitive : there) primitive.pose.position += motion.shift;
    expect_moved(here, extract_refined_csg(moved(cloud, motion), there), motion, diagonal);
  }
}

TEST(Frame, MovesRegionsBack) {
  const Model model = bracket();
  const PointCloud cloud = sample_surface(model, {.count = 6000, .noise = 0.003, .seed = 2});
  const Motion motion{.unit = 1, .shift = {512345.678, -6123456.789, 98.7}};
  PrimitiveSet here(model.primitives.begin(), model.primitives.begin() + 2);
  PrimitiveSet there = here;
  for (Primitive& primitive : there) primitive.pose.position += motion.shift;
  const Verdict one = extract_csg(cloud, here).statistics.verdict;
  const Verdict other = extract_csg(moved(cloud, motion), there).statistics.verdict;
  ASSERT_FALSE(one.regions.empty());
  ASSERT_EQ(other.regions.size(), one.regions.size());
  EXPECT_LT((one.regions[0].place + motion.shift - other.regions[0].place).norm(), 1e-8);
}

TEST(Frame, LeavesKnownPrimitivesAsTheyAre) {
  const Model model = bracket();
  const Motion motion{.unit = 1, .shift = {512345.678, -6123456.789, 98.7}};
  Primitive base = model.primitives[0];
  base.pose.position += motion.shift;
  const PointCloud cloud = moved(sample_surface(model, {.count = 6000, .noise = 0.003, .seed = 2}), motion);
  Primitive ball = model.primitives[2];
  ball.pose.position += motion.shift;
  const Extraction result = reconstruct(cloud, {.known = {base, ball}});
  EXPECT_EQ(result.model.primitives[0].pose.position, base.pose.position);
  EXPECT_EQ(result.model.primitives[1].pose.position, ball.pose.position);
  EXPECT_EQ(result.statistics.verdict.grade, Grade::good) << to_text(result.statistics.verdict);
}

}  // namespace
}  // namespace cloud2csg
