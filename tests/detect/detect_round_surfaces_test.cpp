#include <gtest/gtest.h>

#include <numbers>

#include "detect/detected_parts.hpp"
#include "support/any_profile.hpp"

namespace cloud2csg {
namespace {

using test::by_radius;
using test::cloud_of;
using test::count_of;
using test::detect;

TEST(DetectSurfaces, FindsConcaveSpheresConesAndTori) {
  const Detection detection = detect(cloud_of(test::block_with_pockets(), 0.005, 40'000), 0.005);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), 7U);  // the small end of the cone is the seventh
  const std::vector<Surface> spheres = by_radius(detection, SurfaceType::sphere);
  const std::vector<Surface> cones = by_radius(detection, SurfaceType::cone);
  const std::vector<Surface> tori = by_radius(detection, SurfaceType::torus);
  ASSERT_EQ(spheres.size(), 1U);
  ASSERT_EQ(cones.size(), 1U);
  ASSERT_EQ(tori.size(), 1U);
  EXPECT_TRUE(spheres[0].concave && cones[0].concave && tori[0].concave);
  EXPECT_NEAR(spheres[0].radius, 0.9, 0.005);
  EXPECT_NEAR(cones[0].half_angle, std::atan2(0.7, 1.4), 0.01);
  EXPECT_NEAR(cones[0].axis.z(), 1, 0.001);
  EXPECT_NEAR(tori[0].radius, 0.8, 0.01);
  EXPECT_NEAR(tori[0].minor_radius, 0.25, 0.01);
}

/// A strip of a slender cone is a cylinder, as far as its points can tell.
TEST(DetectSurfaces, TakesSlenderConesForOneSurfaceEach) {
  const test::Part cup = test::without_others(
      {test::placed("outside", Cone{.radius_bottom = 2.5, .radius_top = 3.2, .height = 7}, {0, 0, 0}),
       test::placed("inside", Cone{.radius_bottom = 2.25, .radius_top = 2.95, .height = 7}, {0, 0, 0.4})});
  for (const double noise : {0.0, 0.02}) {
    const Detection detection = detect(cloud_of(cup, noise, 40'000), noise);
    EXPECT_EQ(count_of(detection, SurfaceType::plane), 3U);
    EXPECT_EQ(detection.surfaces.size(), 5U);
    for (const Surface& cone : by_radius(detection, SurfaceType::cone)) {
      EXPECT_NEAR(cone.half_angle, std::atan(0.1), 0.003);
    }
  }
}

/// A pin of radius 2 with a tapered end.
test::Part tapered_pin(double half_angle_deg) {
  const double slope = std::tan(half_angle_deg * std::numbers::pi / 180);
  const double height = std::min(4.0, 1.5 / slope);
  const Cone end{.radius_bottom = 2, .radius_top = 2 - height * slope, .height = height};
  return {.primitives = {test::placed("end", end, {0, 0, 0}),
                         test::placed("shaft", Cylinder{2, 2}, {0, 0, -1 - height / 2})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

/// A strip of a slender cone fits a cylinder, and one of a flat cone fits a plane.
TEST(DetectSurfaces, TakesSlightlyTaperedAndNearlyFlatFacesForOneConeEach) {
  for (const double half_angle_deg : {0.5, 1.0, 2.0, 86.0, 89.0}) {
    // Noise takes the faces of 0.5 degrees for those of a slightly blunter pin, and of 89 degrees for planes.
    const bool is_extreme = half_angle_deg < 1 || half_angle_deg > 88;
    for (const double noise : is_extreme ? std::vector{0.0} : std::vector{0.0, 0.005}) {
      const Detection detection = detect(cloud_of(tapered_pin(half_angle_deg), noise, 40'000), noise);
      const std::vector<Surface> cones = by_radius(detection, SurfaceType::cone);
      EXPECT_EQ(detection.surfaces.size(), 4U) << half_angle_deg;
      ASSERT_EQ(cones.size(), 1U) << half_angle_deg;
      EXPECT_NEAR(cones[0].half_angle * 180 / std::numbers::pi, half_angle_deg, 0.05);
    }
  }
}

/// A part whose only curved surface is an arc turned around an axis that its circle crosses, convex or concave.
test::Part turned_arc_part(double centre, bool is_concave) {
  const Primitive round = test::placed("round", test::turned_arc(centre, 1.2), {0.2, 0.1, 0});
  if (!is_concave) return test::without_others({round});
  return test::without_others({test::placed("block", Box{{6, 5, 4}}, {0, 0, 2}), round});
}

TEST(DetectSurfaces, FindsToriWhoseTubeCrossesTheAxis) {
  for (const double centre : {0.5, -0.5}) {
    for (const bool is_concave : {false, true}) {
      for (const double noise : {0.0, 0.005}) {
        const Detection detection = detect(cloud_of(turned_arc_part(centre, is_concave), noise), noise);
        const std::vector<Surface> tori = by_radius(detection, SurfaceType::torus);
        EXPECT_EQ(detection.surfaces.size(), is_concave ? 7U : 1U) << centre;
        ASSERT_EQ(tori.size(), 1U) << centre;
        EXPECT_EQ(tori[0].concave, is_concave);
        EXPECT_NEAR(tori[0].radius, centre, 1e-5 + noise);
        EXPECT_NEAR(tori[0].minor_radius, 1.2, 1e-5 + noise);
      }
    }
  }
}

}  // namespace
}  // namespace cloud2csg
