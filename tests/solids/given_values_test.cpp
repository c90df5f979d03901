#include <gtest/gtest.h>

#include <numbers>

#include "core/base/random.hpp"
#include "raw/solids/known_parts.hpp"
#include "support/any_profile.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_search_tolerance = 0.02;

/// Points of a surface, with it as they were found.
struct Found {
  PointCloud cloud;
  std::vector<DetectedSurface> surfaces;
};

void add(Found& found, const Surface& surface, const std::vector<Vector3d>& points) {
  DetectedSurface detected{.surface = surface, .points = {}, .rms = 0};
  for (const Vector3d& point : points) {
    detected.points.push_back(static_cast<std::uint32_t>(found.cloud.size()));
    found.cloud.positions.push_back(point);
  }
  found.surfaces.push_back(std::move(detected));
}

/// On a cylinder along z, from 0 to an angle.
std::vector<Vector3d> on_cylinder(double radius, double angle_deg) {
  std::vector<Vector3d> points;
  RandomStream random(1);
  for (int i = 0; i < 500; ++i) {
    const double angle = angle_deg * std::numbers::pi / 180 * random.uniform();
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 4 * random.uniform());
  }
  return points;
}

Surface cylinder_of(double radius) {
  return {.type = SurfaceType::cylinder, .position = {0, 0, 2}, .axis = Vector3d::UnitZ(), .radius = radius};
}

/// A square of this edge, turned about y.
Found turned_square(double edge, double degrees) {
  Found found;
  RandomStream random(2);
  const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, Vector3d::UnitY());
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i) {
    points.emplace_back(turn * Vector3d(edge * (random.uniform() - 0.5), edge * (random.uniform() - 0.5), 0));
  }
  add(found, {.type = SurfaceType::plane, .position = {0, 0, 0}, .axis = turn * Vector3d::UnitZ()}, points);
  return found;
}

GivenSurfaces take(const Found& found, const RegularityOptions& options) {
  return take_given_values(found.cloud, found.surfaces, options, k_search_tolerance);
}

TEST(TakeGivenValues, TakesTheNearestRadiusWithinTheTolerance) {
  Found found;
  add(found, cylinder_of(0.99), on_cylinder(0.99, 360));
  const GivenSurfaces given = take(found, {.radii = {0.5, 1.0, 1.05}});
  EXPECT_EQ(given.surfaces[0].surface.radius, 1.0);
  EXPECT_NEAR(given.surfaces[0].rms, 0.01, 1e-3);
  EXPECT_TRUE(given.fixed[0].radius);
  EXPECT_FALSE(given.fixed[0].direction);
  EXPECT_TRUE(given.warnings.empty());
  ASSERT_EQ(given.snaps.size(), 1U);
  EXPECT_EQ(given.snaps[0].kind, RegularityKind::given_radius);
  EXPECT_NEAR(given.snaps[0].change, 0.01, 1e-12);
}

TEST(TakeGivenValues, KeepsARadiusThatIsNoneOfThemAndSaysSo) {
  Found found;
  add(found, cylinder_of(0.9), on_cylinder(0.9, 360));
  const GivenSurfaces given = take(found, {.radii = {0.5, 1.0}});
  EXPECT_EQ(given.surfaces[0].surface.radius, 0.9);
  EXPECT_FALSE(given.fixed[0].radius);
  EXPECT_TRUE(given.snaps.empty());
  ASSERT_EQ(given.warnings.size(), 1U);
  EXPECT_NE(given.warnings[0].find("cylinder at (0, 0, 2) of 0.9"), std::string::npos) << given.warnings[0];
}

/// A shallow arc tells its radius badly: one that is 10 % off has its points nearly as near, from another place.
TEST(TakeGivenValues, MovesAnArcToWhereItSuitsItsPoints) {
  Found found;
  add(found, cylinder_of(0.9), on_cylinder(0.9, 50));
  const GivenSurfaces given = take(found, {.radii = {1.0}});
  EXPECT_EQ(given.surfaces[0].surface.radius, 1.0);
  EXPECT_LT(given.surfaces[0].rms, 0.003);
  EXPECT_GT(given.surfaces[0].surface.position.head<2>().norm(), 0.05);
}

/// A ring, an apple and a lemon.
TEST(TakeGivenValues, TakesBothRadiiOfATorus) {
  for (const double major : {3.0, 0.3, -0.2}) {
    const double measured = major - 0.01;
    Found found;
    std::vector<Vector3d> points;
    RandomStream random(3);
    while (points.size() < 800) {
      const double u = 2 * std::numbers::pi * random.uniform();
      const double v = 2 * std::numbers::pi * random.uniform();
      const double across = measured + 0.51 * std::cos(v);
      if (across > 0) points.emplace_back(across * std::cos(u), across * std::sin(u), 0.51 * std::sin(v));
    }
    add(found, {.type = SurfaceType::torus, .axis = Vector3d::UnitZ(), .radius = measured, .minor_radius = 0.51},
        points);
    const GivenSurfaces given = take(found, {.radii = {0.5, std::abs(major)}});
    EXPECT_EQ(given.surfaces[0].surface.radius, major);
    EXPECT_EQ(given.surfaces[0].surface.minor_radius, 0.5);
    EXPECT_EQ(given.snaps.size(), 2U);
  }
}

TEST(TakeGivenValues, TurnsDirectionsThatThePointsLetTurn) {
  const RegularityOptions options{.axes = {Vector3d(0, 0, -3)}};
  // Of 0.5, three degrees lift the edges by 0.013.
  const GivenSurfaces small = take(turned_square(0.5, 3), options);
  EXPECT_NEAR((small.surfaces[0].surface.axis - Vector3d::UnitZ()).norm(), 0, 1e-12) << "it keeps its side";
  EXPECT_TRUE(small.fixed[0].direction);
  ASSERT_EQ(small.snaps.size(), 1U);
  EXPECT_EQ(small.snaps[0].kind, RegularityKind::given_direction);
  EXPECT_NEAR(small.snaps[0].change, 3, 1e-6);

  const Found wide = turned_square(5, 3);
  const GivenSurfaces kept = take(wide, options);
  EXPECT_EQ(kept.surfaces[0].surface.axis, wide.surfaces[0].surface.axis);
  EXPECT_FALSE(kept.fixed[0].direction);
  ASSERT_EQ(kept.warnings.size(), 1U);
  EXPECT_NE(kept.warnings[0].find("off by 3 deg"), std::string::npos) << kept.warnings[0];
}

TEST(TakeGivenValues, LeavesDirectionsThatAreFarAlone) {
  const GivenSurfaces given = take(turned_square(0.5, 8), {.axes = {Vector3d::UnitZ(), Vector3d::UnitX()}});
  EXPECT_TRUE(given.snaps.empty());
  EXPECT_TRUE(given.warnings.empty()) << "an oblique face is nothing to speak of";
}

TEST(SurfacesOfKnown, HaveTheSolidsPointsNearestToThem) {
  const KnownSolid post{
      .solid = {.id = "post", .shape = Cylinder{.radius = 1, .height = 4}, .pose = {.position = {5, 0, 0}}},
      .own = {.points = {0, 1, 2}, .rms = 0.1}};
  PointCloud cloud;
  for (const Vector3d& point : {Vector3d(6, 0, 1), Vector3d(5, 0.5, 2.01), Vector3d(5, -1, 0)}) {
    cloud.positions.push_back(point);
  }
  const std::vector<DetectedSurface> surfaces = surfaces_of_known(cloud, std::vector{post});
  ASSERT_EQ(surfaces.size(), 2U) << "no point is on the lower end";
  EXPECT_EQ(surfaces[0].surface.type, SurfaceType::cylinder);
  EXPECT_EQ(surfaces[0].points, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(surfaces[1].surface.type, SurfaceType::plane);
  EXPECT_EQ(surfaces[1].surface.position.z(), 2);
}

TEST(SurfacesOfKnown, LieOnTheSolid) {
  const Pose pose{.position = {1, 2, 3}, .orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)};
  const Polytope wedge{
      .planes = {{{-1, 0, 0}, 1}, {{0, -1, 0}, 1}, {{0, 0, -1}, 1}, {{0.6, 0.8, 0}, 1}, {{0, 0, 1}, 2}}};
  for (const Shape& shape : {Shape(Box{{1, 2, 3}}), Shape(Sphere{1.5}), Shape(Cylinder{0.5, 2}), Shape(Cone{0.2, 1, 2}),
                             Shape(Cone{1, 0.2, 2}), Shape(Cone{1, 1, 2}), Shape(Torus{1, 0.3}), Shape(wedge),
                             Shape(test::turned_arc(0.3, 1)), Shape(test::turned_arc(-0.3, 1))}) {
    const Primitive solid{.id = "solid", .shape = shape, .pose = pose};
    // Points on the surface: any, along the field.
    KnownSolid known{.solid = solid, .own = {}};
    PointCloud cloud;
    RandomStream random(5);
    for (std::uint32_t i = 0; i < 300; ++i) {
      Points place;
      place.push_back(pose.position + 1.5 * Vector3d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform()));
      for (int step = 0; step < 3; ++step) {
        place.set(0, place[0] - signed_distance(solid, place)[0] * gradient(solid, place)[0]);
      }
      if (std::abs(signed_distance(solid, place)[0]) > 1e-9) continue;
      known.own.points.push_back(static_cast<std::uint32_t>(cloud.size()));
      cloud.positions.push_back(place[0]);
    }
    ASSERT_GT(cloud.size(), 100U);
    std::size_t dealt = 0;
    for (const DetectedSurface& found : surfaces_of_known(cloud, std::vector{known})) {
      dealt += found.points.size();
      for (const std::uint32_t i : found.points) {
        EXPECT_NEAR(signed_distance(found.surface, cloud.positions[i]), 0, 1e-8) << type_name(shape);
      }
    }
    EXPECT_EQ(dealt, cloud.size()) << type_name(shape);
  }
}

}  // namespace
}  // namespace cloud2csg
