#include "raw/solids/sectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.hpp"
#include "solids/known_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

/// Points at random angles between two, on the middle of a bend, and that bend.
struct Bend {
  Points positions;
  DetectedSurface surface;
};

Bend bend(double from_deg, double to_deg, std::size_t count) {
  Bend made;
  made.surface.surface = {.type = SurfaceType::torus, .radius = 3, .minor_radius = 0.5};
  RandomStream random(1, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = (from_deg + random.uniform() * (to_deg - from_deg)) * k_degree;
    made.positions.push_back({3 * std::cos(angle), 3 * std::sin(angle), 0});
    made.surface.points.push_back(i);
  }
  return made;
}

std::vector<double> ends_of(const Bend& made, std::vector<DetectedSurface> others = {}) {
  std::vector<double> ends = sector_ends({}, made.positions, {&made.surface}, others, 0.01);
  for (double& end : ends) end /= k_degree;
  std::ranges::sort(ends);
  return ends;
}

TEST(SectorEnds, AFullTurnHasNoneHoweverFewItsPointsAre) {
  for (const std::size_t count : {20U, 60U, 200U, 2000U}) EXPECT_TRUE(ends_of(bend(0, 360, count)).empty()) << count;
}

TEST(SectorEnds, AreWhereThePointsEnd) {
  const std::vector<double> ends = ends_of(bend(20, 110, 1000));
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_NEAR(ends[0], 20, 1);
  EXPECT_NEAR(ends[1], 110, 1);
}

TEST(SectorEnds, AreFoundAcrossTheAngleThatWraps) {
  const std::vector<double> ends = ends_of(bend(150, 240, 1000));
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_NEAR(ends[0], -120, 1);
  EXPECT_NEAR(ends[1], 150, 1);
}

TEST(SectorEnds, TakePlanesAndBendsThatGoOnButNoOthers) {
  DetectedSurface plane;
  plane.surface = {.type = SurfaceType::plane,
                   .axis = Eigen::Vector3d(-std::sin(25 * k_degree), std::cos(25 * k_degree), 0)};
  DetectedSurface next = bend(0, 90, 0).surface;
  next.surface.position = 6 * Eigen::Vector3d(std::cos(115 * k_degree), std::sin(115 * k_degree), 0);
  const std::vector<double> exact = ends_of(bend(20, 110, 1000), {plane, next});
  ASSERT_EQ(exact.size(), 2U);
  EXPECT_NEAR(exact[0], 25, 1e-9);
  EXPECT_NEAR(exact[1], 115, 1e-9);
  plane.surface.position = {0, 1, 0};
  next.surface.minor_radius = 0.2;
  const std::vector<double> own = ends_of(bend(20, 110, 1000), {plane, next});
  ASSERT_EQ(own.size(), 2U);
  EXPECT_NEAR(own[0], 20, 1);
  EXPECT_NEAR(own[1], 110, 1);
}

/// A pipe's points near its start lie on the bend, too.
TEST(SectorEnds, AreWhereAPipeOfThatThicknessGoesOn) {
  const Bend made = bend(-4, 94, 1000);
  const auto pipe = [](double radius, const Eigen::Vector3d& position, const Eigen::Vector3d& axis) {
    DetectedSurface found;
    found.surface = {.type = SurfaceType::cylinder, .position = position, .axis = axis, .radius = radius};
    return found;
  };
  const std::vector<double> ends = ends_of(made, {pipe(0.5, {3, -7, 0}, {0, 1, 0}), pipe(0.3, {7, 3, 0}, {1, 0, 0})});
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_NEAR(ends[0], 0, 1e-9);
  EXPECT_NEAR(ends[1], 94, 1) << "a thinner pipe";
  EXPECT_NEAR(ends_of(made, {pipe(0.5, {0, 3, -7}, {0, 0, 1})})[1], 94, 1) << "a pipe across the bend";
}

/// A piece beside another about the same axis may reach over the other's end, but not over the first end.
TEST(SectorEnds, TheFirstIsInAGapOfAll) {
  Bend one = bend(0, 90, 1000);
  Bend other = bend(45, 135, 500);
  DetectedSurface second = other.surface;
  for (std::uint32_t& i : second.points) i += 1000;
  for (std::size_t i = 0; i < other.positions.size(); ++i) one.positions.push_back(other.positions[i]);
  const std::vector<double> ends = sector_ends({}, one.positions, {&one.surface, &second}, {}, 0.01);
  ASSERT_EQ(ends.size(), 4U);
  EXPECT_TRUE(std::abs(ends[0] / k_degree) < 1 || std::abs(ends[0] / k_degree - 135) < 1) << ends[0] / k_degree;
}

}  // namespace
}  // namespace cloud2csg
