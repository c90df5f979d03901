#include "raw/detect/share_points.hpp"

#include <gtest/gtest.h>

#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

constexpr double k_wall_noise = 0.001;

Surface plane_at(double height) {
  return {.type = SurfaceType::plane, .position = {0, 0, height}};
}

/// 4000 points at random on the unit square: at height 0 on the left, at `step` on the right, each with noise.
WorkCloud stepped(double step, double noise) {
  RandomStream random(5);
  PointCloud cloud;
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d foot(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0);
    cloud.positions.push_back(foot + ((foot.x() > 0 ? step : 0) + noise * random.normal()) * Eigen::Vector3d::UnitZ());
    cloud.normals.push_back(Eigen::Vector3d::UnitZ());
  }
  WorkCloud work = make_work_cloud(cloud);
  // Undo the scaling, so that heights and the noise are the given ones.
  for (OrientedPoint& point : work.points) point.position = point.position * work.diagonal + work.middle;
  return work;
}

/// Shares of the points of each plane that lie on its side of the step.
std::array<double, 2> shares_on_own_side(const WorkCloud& work, double step, const AgreementLimits& limits) {
  const auto grown = [&](double height) {
    return GrownSurface{.surface = plane_at(height), .points = {}, .reach = limits.distance};
  };
  const std::vector<GrownSurface> dealt =
      share_points({grown(0), grown(step)}, work, work.neighbours({}), limits, 0, {});
  std::array<double, 2> shares{};
  std::size_t all = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto is_own = [&](std::uint32_t i) { return (work.points[i].position.x() > 0) == (k == 1); };
    all += dealt[k].points.size();
    shares[k] = static_cast<double>(std::ranges::count_if(dealt[k].points, is_own)) /
                static_cast<double>(std::max<std::size_t>(dealt[k].points.size(), 1));
  }
  EXPECT_GT(all, work.size() * 98 / 100) << "points within three deviations";
  return shares;
}

/// By its own distance alone, every sixth point would be on the wrong side of a step of two deviations.
TEST(SharePoints, LetsThePointsAroundDecideWithinTheNoise) {
  for (const double sigmas : {2.0, 3.0}) {
    const double step = sigmas * k_wall_noise;
    const auto shares = shares_on_own_side(stepped(step, k_wall_noise), step,
                                           {.distance = 3 * k_wall_noise, .noise = k_wall_noise, .cosine = 0.9});
    EXPECT_GT(shares[0], 0.97) << sigmas;
    EXPECT_GT(shares[1], 0.97) << sigmas;
  }
}

/// Beside an edge, most neighbours may be on the other surface.
TEST(SharePoints, GoesByTheOwnDistanceInAnExactCloud) {
  constexpr double k_step = 0.0005;
  constexpr double k_exact = 1e-6;
  const auto shares =
      shares_on_own_side(stepped(k_step, 0), k_step, {.distance = 0.001, .noise = k_exact, .cosine = 0.9});
  EXPECT_EQ(shares[0], 1.0);
  EXPECT_EQ(shares[1], 1.0);
}

TEST(SharePoints, DropsSurfacesWithFewPoints) {
  const AgreementLimits limits{.distance = 3 * k_wall_noise, .noise = k_wall_noise, .cosine = 0.9};
  const WorkCloud work = stepped(0, k_wall_noise);
  const std::vector<GrownSurface> dealt =
      share_points({{.surface = plane_at(0), .points = {}, .reach = limits.distance},
                    {.surface = plane_at(1), .points = {}, .reach = limits.distance}},
                   work, work.neighbours({}), limits, 10, {});
  ASSERT_EQ(dealt.size(), 1U);
  EXPECT_EQ(dealt[0].surface.position.z(), 0);
}

/// A shaft whose radii differ by some standard deviations of the noise, with a groove between them.
Detection of_shaft(double step, double noise) {
  const PrimitiveSet solids{test::placed("thick", Cylinder{1 + step, 2}, {0, 0, -1.5}),
                            test::placed("groove", Cylinder{0.6, 1.1}, {0, 0, 0}),
                            test::placed("thin", Cylinder{1, 2}, {0, 0, 1.5})};
  const CsgTree tree = unite(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  return test::detect(test::cloud_of({.primitives = solids, .tree = tree}, noise), noise);
}

/// They are as near as a common cylinder between them allows, but thousands of points tell them apart.
TEST(Detection, TellsRadiiOfSeparateFacesApartWithinTheNoise) {
  constexpr double k_shaft_noise = 0.01;
  for (const double sigmas : {2.0, 3.0, 4.0}) {
    std::vector<double> radii;
    for (const DetectedSurface& detected : of_shaft(sigmas * k_shaft_noise, k_shaft_noise).surfaces) {
      if (detected.surface.type == SurfaceType::cylinder) radii.push_back(detected.surface.radius);
    }
    std::ranges::sort(radii);
    ASSERT_EQ(radii.size(), 3U) << sigmas;
    EXPECT_NEAR(radii[1], 1, 0.2 * k_shaft_noise) << sigmas;
    EXPECT_NEAR(radii[2], 1 + sigmas * k_shaft_noise, 0.2 * k_shaft_noise) << sigmas;
  }
}

TEST(Detection, TakesFacesOfOneCylinderForOne) {
  std::size_t cylinders = 0;
  for (const DetectedSurface& detected : of_shaft(0, 0.01).surfaces) {
    cylinders += detected.surface.type == SurfaceType::cylinder ? 1 : 0;
  }
  EXPECT_EQ(cylinders, 2U);
}

}  // namespace
}  // namespace cloud2csg
