#include <gtest/gtest.h>

#include <numbers>

#include "cloud2csg/solids.hpp"
#include "solids/known_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_tolerance = 0.01;

DetectedSurface with_points(Surface surface, std::size_t points) {
  return {.surface = surface, .points = std::vector<std::uint32_t>(points, 0), .rms = 0};
}

Eigen::Vector3d turned(const Eigen::Vector3d& direction, const Eigen::Vector3d& about, double degrees) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, about) * direction;
}

Surface cylinder_at(const Eigen::Vector3d& position, const Eigen::Vector3d& axis, double radius) {
  return {.type = SurfaceType::cylinder, .position = position, .axis = axis, .radius = radius};
}

const Eigen::Vector3d k_x = Eigen::Vector3d::UnitX();
const Eigen::Vector3d k_z = Eigen::Vector3d::UnitZ();

TEST(Regularise, MakesDirectionsEqualOrOrthogonal) {
  const std::vector<DetectedSurface> surfaces{
      with_points(test::plane_at({0, 0, 1}, k_z), 1000),
      with_points(test::plane_at({0, 0, -1}, turned(-k_z, k_x, 0.5)), 500),
      with_points(test::plane_at({1, 0, 0}, turned(k_x, Eigen::Vector3d::UnitY(), 0.7)), 300),
      with_points(cylinder_at({0, 0, 0}, turned(k_z, k_x, -0.4), 1), 200)};
  const RegularSurfaces regular = regularise(surfaces, 1e-4);  // too small to lay them along axes of coordinates
  const auto axis = [&](std::size_t i) { return regular.surfaces[i].surface.axis; };
  EXPECT_NEAR(axis(0).dot(axis(1)), -1, 1e-12);
  EXPECT_NEAR(axis(0).dot(axis(2)), 0, 1e-12);
  EXPECT_NEAR(axis(0).dot(axis(3)), 1, 1e-12);
  EXPECT_LT(axis(0).cross(k_z).norm(), 0.004) << "what has most points is moved least";
  EXPECT_EQ(regular.snaps.size(), 4U);
  for (const Snap& snap : regular.snaps) {
    EXPECT_EQ(snap.kind, RegularityKind::direction);
    EXPECT_LT(snap.change, 1.0);
  }
}

TEST(Regularise, LeavesWhatIsFarFromRegular) {
  const std::vector<DetectedSurface> surfaces{
      with_points(test::plane_at({0, 0, 1}, k_z), 1000), with_points(test::plane_at({0, 0, 1.02}, k_z), 1000),
      with_points(test::plane_at({0, 0, 0}, turned(k_z, k_x, 3)), 500),
      with_points(cylinder_at({0, 0, 0}, k_z, 1), 200), with_points(cylinder_at({0.02, 0, 0}, k_z, 1.02), 200)};
  const RegularSurfaces regular = regularise(surfaces, k_tolerance);
  EXPECT_TRUE(regular.snaps.empty());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    EXPECT_EQ(regular.surfaces[i].surface.position, surfaces[i].surface.position);
    EXPECT_LT((regular.surfaces[i].surface.axis - surfaces[i].surface.axis).norm(), 1e-12);
  }
}

TEST(Regularise, LaysDirectionsAlongAxesOfCoordinatesWhereThatMovesNothingFar) {
  // Two units apart: 0.2 degrees move one of them by 0.007.
  const Eigen::Vector3d up = turned(k_z, k_x, 0.2);
  const std::vector<DetectedSurface> surfaces{with_points(test::plane_at({0, 0, 1}, up), 1000),
                                              with_points(test::plane_at({0, 0, -1}, -up), 1000),
                                              with_points(test::plane_at({0, 0, 0}, k_x), 500)};
  const RegularSurfaces regular = regularise(surfaces, 0.01);
  EXPECT_EQ(regular.surfaces[0].surface.axis, k_z);
  EXPECT_EQ(regular.surfaces[1].surface.axis, -k_z);
  EXPECT_EQ(regular.surfaces[2].surface.axis, k_x);
  EXPECT_EQ(regularise(surfaces, 0.005).surfaces[0].surface.axis, up) << "that would be too far";
  // What stands across a direction that is no axis stays there, even near an axis.
  std::vector<DetectedSurface> turned_off = surfaces;
  for (std::size_t i : {0UL, 1UL}) turned_off[i].surface.axis = turned(turned_off[i].surface.axis, k_x, 2.3);
  turned_off.push_back(with_points(test::plane_at({0, 0, 0}, turned(Eigen::Vector3d::UnitY(), k_x, 2.6)), 500));
  const RegularSurfaces kept = regularise(turned_off, 0.5);
  EXPECT_NEAR(kept.surfaces[0].surface.axis.dot(kept.surfaces[3].surface.axis), 0, 1e-12);
}

TEST(Regularise, SharesOffsetsAxesAndRadiiByTheirPoints) {
  const std::vector<DetectedSurface> surfaces{
      with_points(test::plane_at({0, 0, 1}, k_z), 300), with_points(test::plane_at({5, 0, 1.008}, -k_z), 100),
      with_points(cylinder_at({0, 0, 0}, k_z, 1), 300), with_points(cylinder_at({0.004, 0, 7}, -k_z, 1.008), 100)};
  const RegularSurfaces regular = regularise(surfaces, k_tolerance);
  const auto surface = [&](std::size_t i) { return regular.surfaces[i].surface; };
  EXPECT_NEAR(surface(0).position.z(), 1.002, 1e-12);
  EXPECT_NEAR(surface(1).position.z(), 1.002, 1e-12);
  EXPECT_NEAR(surface(2).position.x(), 0.001, 1e-12);
  EXPECT_NEAR(surface(3).position.x(), 0.001, 1e-12);
  EXPECT_EQ(surface(3).position.z(), 7);
  EXPECT_NEAR(surface(2).radius, 1.002, 1e-12);
  EXPECT_EQ(surface(2).radius, surface(3).radius);
}

TEST(Regularise, MakesOthersLikeWhatIsFixed) {
  const Eigen::Vector3d oblique = turned(k_z, k_x, 0.6);
  // Those that are fixed have the fewest points.
  const std::vector<DetectedSurface> surfaces{
      with_points(test::plane_at({0, 0, 1}, k_z), 1000), with_points(test::plane_at({0, 0, 1.004}, oblique), 10),
      with_points(cylinder_at({0.003, 0, 0}, k_z, 1.005), 1000), with_points(cylinder_at({0, 0, 0}, oblique, 1), 10)};
  const FixedValues all{.direction = true, .position = true, .radius = true};
  const std::vector<FixedValues> fixed{{}, all, {}, all};
  const RegularSurfaces regular = regularise(surfaces, k_tolerance, 1.0, fixed);
  const auto surface = [&](std::size_t i) { return regular.surfaces[i].surface; };
  for (const std::size_t i : {1U, 3U}) {
    EXPECT_EQ(surface(i).axis, surfaces[i].surface.axis);
    EXPECT_EQ(surface(i).position, surfaces[i].surface.position);
    EXPECT_EQ(surface(i).radius, surfaces[i].surface.radius);
  }
  EXPECT_NEAR(surface(0).axis.dot(oblique), 1, 1e-12);
  EXPECT_NEAR(oblique.dot(surface(0).position - surface(1).position), 0, 1e-12);
  EXPECT_NEAR(surface(2).axis.cross(oblique).norm(), 0, 1e-12);
  EXPECT_NEAR(oblique.cross(surface(2).position).norm(), 0, 1e-12);
  EXPECT_EQ(surface(2).radius, 1);
  for (const Snap& snap : regular.snaps) EXPECT_EQ(snap.surface % 2, 0U);
}

TEST(Regularise, MovesNoTwoFixedSurfacesTogether) {
  const std::vector<DetectedSurface> surfaces{with_points(test::plane_at({0, 0, 1}, k_z), 100),
                                              with_points(test::plane_at({0, 0, 1.005}, turned(k_z, k_x, 0.5)), 100)};
  const std::vector<FixedValues> fixed(2, {.direction = true, .position = true, .radius = true});
  const RegularSurfaces regular = regularise(surfaces, k_tolerance, 1.0, fixed);
  EXPECT_TRUE(regular.snaps.empty());
  EXPECT_EQ(regular.surfaces[1].surface.axis, surfaces[1].surface.axis);
  EXPECT_EQ(regular.surfaces[1].surface.position, surfaces[1].surface.position);
}

}  // namespace
}  // namespace cloud2csg
