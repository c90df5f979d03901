#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloud2csg/advanced/solids.hpp"
#include "core/base/random.hpp"
#include "solids/known_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_tolerance = 0.01;

DetectedSurface with_points(const Surface& surface, std::size_t points) {
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

/// A short piece of a bore is turned farther than what is sure of its direction.
TEST(Regularise, TurnsWhatIsUnsureFarther) {
  DetectedSurface bore = with_points(cylinder_at({0, 0, 0}, turned(k_z, k_x, 2), 1), 100);
  const DetectedSurface face = with_points(test::plane_at({0, 0, 1}, k_z), 1000);
  for (const double sure_to_deg : {0.1, 0.8}) {
    bore.turn_deg = sure_to_deg;
    const RegularSurfaces regular = regularise(std::vector{face, bore}, k_tolerance);
    const bool is_parallel = regular.surfaces[0].surface.axis.cross(regular.surfaces[1].surface.axis).norm() < 1e-9;
    EXPECT_EQ(is_parallel, sure_to_deg > 0.5);
  }
  bore.surface.axis = turned(k_z, k_x, 4);
  bore.turn_deg = 10;
  EXPECT_TRUE(regularise(std::vector{face, bore}, k_tolerance).snaps.empty()) << "what is not known is not made up";
}

/// A cone is turned about its apex, which is far from its points.
TEST(Regularise, SurfacesStayOnTheirPointsWhenTheyAreTurned) {
  const double noise = 0.002;
  const Eigen::Vector3d apex(0, 0, 12);
  Points positions;
  DetectedSurface cone = with_points({.type = SurfaceType::cone, .position = apex, .axis = -k_z, .half_angle = 0.1}, 0);
  RandomStream random(3);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double height = random.uniform(0, 2);
    const double radius = (12 - height) * std::tan(0.1) + noise * random.normal();
    positions.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
    cone.points.push_back(i);
  }
  cone.rms = noise;
  cone.surface.position = turned(apex, k_x, 0.5);
  cone.surface.axis = turned(-k_z, k_x, 0.5);
  const DetectedSurface face = with_points(test::plane_at({0, 0, 0}, -k_z), 5000);
  const std::vector<FixedValues> fixed{{.direction = true}, {}};
  const auto rms_of = [&](const Surface& surface) {
    double squares = 0;
    for (const double distance : signed_distance(surface, positions)) squares += distance * distance;
    return std::sqrt(squares / static_cast<double>(positions.size()));
  };
  const auto turned_cone = [&](const Points& known) {
    Surface result = regularise(std::vector{face, cone}, k_tolerance, 1, fixed, known).surfaces[1].surface;
    EXPECT_LT(result.axis.cross(k_z).norm(), 1e-12);
    return result;
  };
  EXPECT_GT(rms_of(turned_cone({})), 10 * noise);
  EXPECT_LT(rms_of(turned_cone(positions)), 1.1 * noise);
}

/// Six bores with counterbores around a hub of another radius, all off by some: they move together.
TEST(Regularise, PutsAxesOfEqualCylindersIntoCircles) {
  std::vector<DetectedSurface> surfaces{with_points(test::plane_at({0, 0, 1}, k_z), 1000),
                                        with_points(cylinder_at({2, 3, 0}, k_z, 1), 900)};
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3;
    const double off = 0.2 * k_tolerance * (k % 3 - 1);
    const Eigen::Vector3d place(2 + (2 + off) * std::cos(angle), 3 + (2 - off) * std::sin(angle), 0.5 * k);
    surfaces.push_back(with_points(cylinder_at(place, k_z, 0.2), 50));
    surfaces.push_back(with_points(cylinder_at(place, k_z, 0.3), 30));
  }
  const RegularSurfaces regular = regularise(surfaces, k_tolerance);
  for (std::size_t k = 0; k < 6; ++k) {
    const Eigen::Vector3d bore = regular.surfaces[2 + 2 * k].surface.position;
    const Eigen::Vector3d counterbore = regular.surfaces[3 + 2 * k].surface.position;
    const double angle = static_cast<double>(k) * std::numbers::pi / 3;
    const double radius = std::hypot(bore.x() - 2, bore.y() - 3);
    EXPECT_NEAR(bore.x(), 2 + radius * std::cos(angle), 1e-12);
    EXPECT_NEAR(bore.y(), 3 + radius * std::sin(angle), 1e-12);
    EXPECT_EQ(bore.z(), 0.5 * static_cast<double>(k));
    EXPECT_EQ(bore, counterbore);
    EXPECT_LE((bore - surfaces[2 + 2 * k].surface.position).norm(), k_tolerance);
  }
  EXPECT_EQ(regular.surfaces[1].surface.position, surfaces[1].surface.position) << "the hub is where it was";
  const auto is_arranged = [](const Snap& snap) { return snap.kind == RegularityKind::arrangement; };
  EXPECT_GE(std::ranges::count_if(regular.snaps, is_arranged), 8);
}

/// A grid turned as its plate is, one bore of which is known: that is not moved, and is in no grid.
TEST(Regularise, PutsAxesIntoGridsAlongThePlate) {
  const Eigen::Vector3d side = turned(k_x, k_z, 31);
  const Eigen::Vector3d along = k_z.cross(side);
  std::vector<DetectedSurface> surfaces{with_points(test::plane_at({9, 0, 0}, side), 1000)};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double off = 0.3 * k_tolerance * ((i + j) % 3 - 1);
      surfaces.push_back(with_points(cylinder_at((0.5 * i + off) * side + (0.4 * j - off) * along, k_z, 0.1), 50));
    }
  }
  surfaces.push_back(with_points(cylinder_at(2.002 * side, k_z, 0.1), 50));
  std::vector<FixedValues> fixed(surfaces.size());
  fixed.back().position = true;
  const RegularSurfaces regular = regularise(surfaces, k_tolerance, 1.0, fixed);
  EXPECT_EQ(regular.surfaces.back().surface.position, surfaces.back().surface.position);
  const auto place = [&](std::size_t i, std::size_t j) -> Eigen::Vector3d {
    return regular.surfaces[1 + 3 * i + j].surface.position;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(side.dot(place(i, j)), side.dot(place(i, 0)), 1e-12);
      EXPECT_NEAR(along.dot(place(i, j)), along.dot(place(0, j)), 1e-12);
    }
  }
  EXPECT_NEAR(side.dot(place(3, 0) - place(2, 0)), side.dot(place(1, 0) - place(0, 0)), 1e-12);
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
