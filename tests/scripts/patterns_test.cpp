#include "io/scripts/patterns.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "support/any_solid.hpp"
#include "support/flange.hpp"

namespace cloud2csg {
namespace {

using script::CirclePattern;
using script::find_patterns;
using script::GridPattern;
using script::LinePattern;
using script::MirrorPattern;
using script::Part;
using script::Pattern;

std::vector<Part> parts_of(const PrimitiveSet& primitives) {
  std::vector<Part> parts;
  for (const Primitive& primitive : primitives) parts.push_back({.solid = primitive});
  return parts;
}

/// Each member is where its pattern puts it, and no part is in two.
void expect_sound(const std::vector<Part>& parts, const std::vector<Pattern>& patterns, double tolerance) {
  std::vector<int> uses(parts.size(), 0);
  for (const Pattern& pattern : patterns) {
    EXPECT_GE(pattern.members.size(), parts[pattern.members[0]].kind == Part::Kind::solid ? 3U : 2U);
    EXPECT_LE(pattern.deviation, tolerance);
    for (std::size_t place = 0; place < pattern.members.size(); ++place) {
      const Part member = script::member_of(parts, pattern, place);
      EXPECT_LE(script::misfit(member, parts[pattern.members[place]], tolerance), tolerance);
      EXPECT_EQ(++uses[pattern.members[place]], 1);
    }
  }
}

/// The patterns of single solids.
std::vector<Pattern> sound_patterns(const PrimitiveSet& primitives) {
  const std::vector<Part> parts = parts_of(primitives);
  std::vector<Pattern> patterns = find_patterns(parts, 1e-6);
  expect_sound(parts, patterns, 1e-6);
  return patterns;
}

TEST(Patterns, FindsTheHolesAndFeetOfAFlange) {
  const Model model = test::flange();
  const std::vector<Pattern> patterns = sound_patterns(model.primitives);
  ASSERT_EQ(patterns.size(), 2U);
  ASSERT_EQ(patterns[0].members.size(), 6U);
  const auto& circle = std::get<CirclePattern>(patterns[0].motion);
  EXPECT_TRUE(circle.is_full);
  EXPECT_NEAR(circle.angle_deg, 60, 1e-9);
  EXPECT_NEAR((circle.centre - Eigen::Vector3d(30, 20, 5)).norm(), 0, 1e-9);
  EXPECT_NEAR((circle.axis - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-9);
  ASSERT_EQ(patterns[1].members.size(), 4U);
  EXPECT_NEAR((std::get<LinePattern>(patterns[1].motion).step - Eigen::Vector3d(8, 0, 0)).norm(), 0, 1e-12);
}

TEST(Patterns, NeedEqualSizesTurnsAndSteps) {
  const auto count = [](const std::function<void(PrimitiveSet&)>& spoil) {
    PrimitiveSet row;
    for (int i = 0; i < 3; ++i) {
      row.push_back({.id = "p", .shape = Box{.size = {1, 2, 3}}, .pose = {.position = {5.0 * i, 0, 0}}});
    }
    spoil(row);
    return sound_patterns(row).size();
  };
  EXPECT_EQ(count([](PrimitiveSet&) {}), 1U);
  EXPECT_EQ(count([](PrimitiveSet& row) { row[1].pose.position.x() += 1e-5; }), 0U);
  EXPECT_EQ(count([](PrimitiveSet& row) { row[1].shape = Box{.size = {1, 2, 3.00001}}; }), 0U);
  EXPECT_EQ(count([](PrimitiveSet& row) { row[1].shape = Sphere{.radius = 1}; }), 0U);
  EXPECT_EQ(count([](PrimitiveSet& row) { row[1].displacement = Displacement{.frequency = 1}; }), 0U);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(count([&](PrimitiveSet& row) { row[1].pose.orientation = Eigen::AngleAxisd(1e-4, z); }), 0U);
  // Half a turn of a box is none.
  EXPECT_EQ(count([&](PrimitiveSet& row) { row[1].pose.orientation = Eigen::AngleAxisd(std::numbers::pi, z); }), 1U);
}

RC_GTEST_PROP(Patterns, AreFoundWhereverTheyLie, ()) {
  const Pose frame = test::any_pose(5);
  const int count = *rc::gen::inRange(3, 9);
  const bool is_circle = *rc::gen::arbitrary<bool>();
  Primitive first{.id = "p", .shape = Cylinder{.radius = 0.5, .height = 2}, .pose = test::any_pose(3)};
  if (is_circle && std::hypot(first.pose.position.x(), first.pose.position.y()) < 0.1) first.pose.position.x() += 1;
  PrimitiveSet primitives;
  const Eigen::Vector3d step = test::any_vector(0.5, 2);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const Pose motion =
        is_circle ? Pose{.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))}
                  : Pose{.position = i * step};
    primitives.push_back(first);
    primitives.back().pose = compose(frame, compose(motion, first.pose));
  }
  // Its order in the model says nothing.
  std::rotate(primitives.begin(), primitives.begin() + *rc::gen::inRange(0, count), primitives.end());
  const std::vector<Pattern> patterns = sound_patterns(primitives);
  RC_ASSERT(patterns.size() == 1U);
  RC_ASSERT(patterns[0].members.size() == static_cast<std::size_t>(count));
  RC_ASSERT(std::holds_alternative<CirclePattern>(patterns[0].motion) == is_circle);
}

RC_GTEST_PROP(Patterns, GridsAreOnePattern, ()) {
  const Pose frame = test::any_pose(5);
  const int columns = *rc::gen::inRange(2, 6);
  const int rows = *rc::gen::inRange(2, 6);
  // Not square: four at the corners of a square are on a circle.
  const double across = columns == rows ? 1.7 : 1.0;
  PrimitiveSet primitives;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const Pose place{.position = {1.0 * i, across * j, 0}};
      primitives.push_back({.id = "p", .shape = Sphere{.radius = 0.2}, .pose = compose(frame, place)});
    }
  }
  std::rotate(primitives.begin(), primitives.begin() + *rc::gen::inRange(0, columns * rows), primitives.end());
  const std::vector<Pattern> patterns = sound_patterns(primitives);
  RC_ASSERT(patterns.size() == 1U);
  RC_ASSERT(patterns[0].members.size() == primitives.size());
  RC_ASSERT(std::holds_alternative<GridPattern>(patterns[0].motion));
}

PrimitiveSet cylinders_at(const std::vector<Eigen::Vector3d>& places) {
  PrimitiveSet primitives;
  for (const Eigen::Vector3d& place : places) {
    primitives.push_back({.id = "p", .shape = Cylinder{.radius = 1, .height = 9}, .pose = {.position = place}});
  }
  return primitives;
}

TEST(Patterns, FourInASquareAreAGridWhereItLiesAlongTheAxes) {
  const auto first_of = [](const std::vector<Eigen::Vector3d>& places) {
    return sound_patterns(cylinders_at(places))[0];
  };
  const Pattern square = first_of({{10, 10, 0}, {-10, 10, 0}, {-10, -10, 0}, {10, -10, 0}});
  ASSERT_TRUE(std::holds_alternative<GridPattern>(square.motion));
  EXPECT_EQ(std::get<GridPattern>(square.motion).columns, 2U);
  const Pattern around = first_of({{10, 0, 0}, {0, 10, 0}, {-10, 0, 0}, {0, -10, 0}});
  ASSERT_TRUE(std::holds_alternative<CirclePattern>(around.motion));
  EXPECT_TRUE(std::get<CirclePattern>(around.motion).is_full);
  // One in the middle makes rows of three on the diagonals; the four are more.
  const Pattern with_middle = first_of({{0, 0, 0}, {10, 10, 0}, {-10, 10, 0}, {-10, -10, 0}, {10, -10, 0}});
  EXPECT_TRUE(std::holds_alternative<GridPattern>(with_middle.motion));
  EXPECT_EQ(with_middle.members.size(), 4U);
  const Pattern oblong = first_of({{10, 5, 0}, {-10, 5, 0}, {-10, -5, 0}, {10, -5, 0}});
  EXPECT_TRUE(std::holds_alternative<GridPattern>(oblong.motion));
}

/// A block less a bore beside its middle, with a rib: no two of its sides are alike.
Part bracket(double rib = 0.5) {
  const Part block{.solid = {.id = "block", .shape = Box{.size = {4, 3, 2}}}};
  const Part bore{
      .solid = {.id = "bore", .shape = Cylinder{.radius = 0.5, .height = 3}, .pose = {.position = {1, 0.5, 0}}}};
  const Part ribbed{.solid = {.id = "rib", .shape = Box{.size = {rib, 3, 1}}, .pose = {.position = {-1, 0, 1.2}}}};
  return {
      .kind = Part::Kind::common, .kept = {{.kind = Part::Kind::united, .kept = {block, ribbed}}}, .removed = {bore}};
}

RC_GTEST_PROP(Patterns, OfCombinationsAreFoundWhereverTheyLie, ()) {
  const Pose frame = test::any_pose(5);
  const int count = *rc::gen::inRange(3, 7);
  const bool is_circle = *rc::gen::arbitrary<bool>();
  std::vector<Part> parts;
  for (int i = 0; i < count; ++i) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * i / count, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d out(9, 0, 0);
    const Pose motion =
        is_circle ? Pose{.position = turn * out, .orientation = Eigen::Quaterniond(turn)} : Pose{.position = i * out};
    parts.push_back(script::moved(bracket(), compose(frame, motion)));
    // Operands have no order.
    std::ranges::reverse(parts.back().kept[0].kept);
    if (i % 2 == 0) std::ranges::reverse(parts[0].kept[0].kept);
  }
  parts.push_back(script::moved(bracket(0.6), {.position = {-9, 0, 0}}));
  const std::vector<Pattern> patterns = find_patterns(parts, 1e-6);
  expect_sound(parts, patterns, 1e-6);
  RC_ASSERT(patterns.size() == 1U);
  RC_ASSERT(patterns[0].members.size() == static_cast<std::size_t>(count));
  RC_ASSERT(std::holds_alternative<CirclePattern>(patterns[0].motion) == is_circle);
}

RC_GTEST_PROP(Patterns, TwoCombinationsAreMirrorImagesOrAStep, ()) {
  const Pose frame = test::any_pose(5);
  const bool is_mirror = *rc::gen::arbitrary<bool>();
  const Eigen::Vector3d normal = test::any_vector(0.5, 2).normalized();
  const script::MirrorPlane plane{.normal = normal, .offset = 7};
  const Part first = script::moved(bracket(), frame);
  const Part second = is_mirror ? script::mirrored(first, plane) : script::moved(first, {.position = {3, 8, 1}});
  const std::vector<Part> parts{first, second};
  const std::vector<Pattern> patterns = find_patterns(parts, 1e-6);
  expect_sound(parts, patterns, 1e-6);
  if ((script::centre_of(first) - script::centre_of(second)).norm() < 1e-3) return;
  RC_ASSERT(patterns.size() == 1U);
  RC_ASSERT(std::holds_alternative<MirrorPattern>(patterns[0].motion) == is_mirror);
  // Single solids are no shorter as a pair.
  RC_ASSERT(find_patterns(parts_of(cylinders_at({{0, 0, 0}, {9, 0, 0}})), 1e-6).empty());
}

RC_GTEST_PROP(Patterns, OfAnySolidsAreSound, ()) {
  PrimitiveSet primitives;
  const std::size_t count = *rc::gen::inRange<std::size_t>(0, 14);
  const std::array shapes{test::any_shape(), test::any_shape()};
  for (std::size_t i = 0; i < count; ++i) {
    // On a small lattice, where rows, squares and their halves overlap.
    const auto whole = [] { return static_cast<double>(*rc::gen::inRange(0, 3)); };
    const double x = whole();
    const double y = whole();
    primitives.push_back({.id = "p", .shape = shapes[i % 2], .pose = {.position = {x, y, whole()}}});
  }
  (void)sound_patterns(primitives);
}

}  // namespace
}  // namespace cloud2csg
