#include "raw/detect/recombine_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "detect/detected_parts.hpp"
#include "raw/detect/propose.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_turned_noise = 0.002;
constexpr SearchLimits k_turned_limits{
    .agreement = {.distance = k_deviations * k_turned_noise, .noise = k_turned_noise, .cosine = 0.9},
    .link = 0.05,
    .least_points = 15};

/// A cloud of diagonal about 1.
struct Turned {
  WorkCloud cloud;
  NeighbourTable neighbours;
};

/// A surface of revolution whose radius above height 0 changes by `slope`.
Turned make_turned(double slope, std::uint64_t seed = 7) {
  RandomStream random(seed);
  PointCloud cloud;
  for (std::size_t k = 0; k < 8000; ++k) {
    const double height = random.uniform(-0.15, 0.15);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double here = height > 0 ? slope : 0;
    const Vector3d outward(std::cos(angle), std::sin(angle), 0);
    const Vector3d normal = (outward + here * Vector3d::UnitZ()).normalized();
    const Vector3d foot = (0.3 - here * height) * outward + height * Vector3d::UnitZ();
    cloud.positions.push_back(foot + k_turned_noise * random.normal() * normal);
    cloud.normals.push_back(normal);
  }
  Turned turned{.cloud = make_work_cloud(cloud), .neighbours = {}};
  // Undo the scaling, so that sizes and the noise are the given ones.
  for (OrientedPoint& p : turned.cloud.points) {
    p.position = p.position * turned.cloud.diagonal + turned.cloud.middle;
  }
  turned.neighbours = turned.cloud.neighbours({.threads = 2});
  return turned;
}

/// A surface of this type fitted to the points with is_wanted(height). These are its points.
template <class IsWanted>
GrownSurface fitted_to(const Turned& turned, SurfaceType type, const IsWanted& is_wanted) {
  GrownSurface grown{.surface = {}, .points = {}, .reach = k_turned_limits.agreement.distance};
  for (std::uint32_t i = 0; i < turned.cloud.size(); ++i) {
    if (is_wanted(turned.cloud.points[i].position.z())) grown.points.push_back(i);
  }
  grown.surface = estimate_plausible(type, turned.cloud.some_of(grown.points, 2000), k_turned_limits.agreement).value();
  return grown;
}

std::optional<std::vector<GrownSurface>> recombined(const Turned& turned, const std::vector<GrownSurface>& surfaces) {
  return recombined(surfaces, turned.cloud, turned.neighbours, k_turned_limits, {.threads = 2});
}

bool is_below(double height) {
  return height < 0;
}
bool is_above(double height) {
  return height >= 0;
}

TEST(Recombined, LeavesRightSurfacesAlone) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Turned turned = make_turned(0.5, seed);
    EXPECT_FALSE(recombined(
        turned, {fitted_to(turned, SurfaceType::cylinder, is_below), fitted_to(turned, SurfaceType::cone, is_above)}));
  }
}

TEST(Recombined, ChangesTheTypeOfOneSurface) {
  const Turned turned = make_turned(0.5);
  const auto result = recombined(
      turned, {fitted_to(turned, SurfaceType::sphere, is_below), fitted_to(turned, SurfaceType::cone, is_above)});
  ASSERT_TRUE(result);
  ASSERT_EQ(result->size(), 2U);
  EXPECT_EQ(result->front().surface.type, SurfaceType::cone);
  EXPECT_EQ(result->back().surface.type, SurfaceType::cylinder);
  EXPECT_NEAR(result->back().surface.radius, 0.3, 0.001);
  EXPECT_GT(result->back().points.size(), 3900U);
}

/// Two bands of a cylinder are as good as two spheres, as far as each alone can tell.
TEST(Recombined, PutsOneSurfaceInPlaceOfTwo) {
  const Turned turned = make_turned(0);
  const auto result = recombined(
      turned, {fitted_to(turned, SurfaceType::sphere, is_below), fitted_to(turned, SurfaceType::sphere, is_above)});
  ASSERT_TRUE(result);
  ASSERT_EQ(result->size(), 1U);
  EXPECT_EQ(result->front().surface.type, SurfaceType::cylinder);
}

/// A sphere has the cylinder and the lower part of the cone, and a cone the rest of it.
TEST(Recombined, PutsOneSurfaceBesideOneThatStays) {
  const Turned turned = make_turned(0.5);
  const auto is_high = [](double height) { return height > 0.05; };
  const auto is_low = [](double height) { return height <= 0.05; };
  std::vector<GrownSurface> surfaces{fitted_to(turned, SurfaceType::sphere, is_low),
                                     fitted_to(turned, SurfaceType::cone, is_high)};
  const auto result = recombined(turned, surfaces);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->size(), 2U);
  EXPECT_EQ(result->back().surface.type, SurfaceType::cylinder);
}

}  // namespace
}  // namespace cloud2csg
