#include "export/patterns.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>
#include <numeric>

#include "support/any_solid.hpp"
#include "support/flange.hpp"

namespace cloud2csg {
namespace {

using script::CirclePattern;
using script::find_patterns;
using script::GridPattern;
using script::LinePattern;
using script::Pattern;

std::vector<PrimitiveIndex> all_of(const PrimitiveSet& primitives) {
  std::vector<PrimitiveIndex> all(primitives.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  return all;
}

/// Each member is where its pattern puts it, and no primitive is in two.
void expect_sound(const PrimitiveSet& primitives, const std::vector<Pattern>& patterns, double tolerance) {
  std::vector<int> uses(primitives.size(), 0);
  for (const Pattern& pattern : patterns) {
    EXPECT_GE(pattern.members.size(), 3U);
    EXPECT_LE(pattern.deviation, tolerance);
    for (std::size_t place = 0; place < pattern.members.size(); ++place) {
      const Primitive member = script::member_of(primitives, pattern, place);
      EXPECT_LE(script::misfit(member, primitives[pattern.members[place]]), tolerance);
      EXPECT_EQ(++uses[pattern.members[place]], 1);
    }
  }
}

TEST(Patterns, FindsTheHolesAndFeetOfAFlange) {
  const Model model = test::flange();
  const std::vector<Pattern> patterns = find_patterns(model.primitives, all_of(model.primitives), 1e-6);
  expect_sound(model.primitives, patterns, 1e-6);
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
    return find_patterns(row, all_of(row), 1e-6).size();
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
  const std::vector<Pattern> patterns = find_patterns(primitives, all_of(primitives), 1e-6);
  expect_sound(primitives, patterns, 1e-6);
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
  const std::vector<Pattern> patterns = find_patterns(primitives, all_of(primitives), 1e-6);
  expect_sound(primitives, patterns, 1e-6);
  RC_ASSERT(patterns.size() == 1U);
  RC_ASSERT(patterns[0].members.size() == primitives.size());
  RC_ASSERT(std::holds_alternative<GridPattern>(patterns[0].motion));
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
  expect_sound(primitives, find_patterns(primitives, all_of(primitives), 1e-6), 1e-6);
}

}  // namespace
}  // namespace cloud2csg
