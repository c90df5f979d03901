#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <stop_token>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/error.hpp"
#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using test::by_radius;
using test::cloud_of;
using test::count_of;
using test::detect;

void expect_plate(const Detection& detection, double tolerance) {
  ASSERT_EQ(detection.surfaces.size(), 9U);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), 6U);
  const std::vector<Surface> holes = by_radius(detection, SurfaceType::cylinder);
  ASSERT_EQ(holes.size(), 3U);
  const std::vector<Eigen::Vector3d> centres{{1.4, 0.8, 0}, {-1.2, 0.3, 0}, {0.4, -0.5, 0}};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(holes[k].concave);
    EXPECT_NEAR(holes[k].radius, 0.3 + 0.1 * static_cast<double>(k), tolerance);
    EXPECT_NEAR(std::abs(holes[k].axis.z()), 1, 0.002);
    EXPECT_LT((holes[k].position - centres[k]).head<2>().norm(), tolerance);
  }
}

TEST(DetectSurfaces, FindsTheFacesAndHolesOfAPlate) {
  const Detection detection = detect(cloud_of(test::plate_with_holes(), 0), 0);
  expect_plate(detection, 1e-4);
  EXPECT_EQ(detection.unexplained, 0U);
}

TEST(DetectSurfaces, FindsThemInNoiseOfFourTenthsPercent) {
  expect_plate(detect(cloud_of(test::plate_with_holes(), 0.02, 40'000, 8), 0.02), 0.01);
}

TEST(DetectSurfaces, SaysHowSureTheDirectionOfAShortPieceIs) {
  const test::Part plate = test::plate_with_holes();
  const Detection detection = detect(cloud_of(plate, 0.02, 20'000), 0.02);
  ASSERT_EQ(detection.surfaces.size(), 9U);  // six faces, three bores
  for (const DetectedSurface& found : detection.surfaces) {
    const double sine = found.surface.axis.cwiseAbs().maxCoeff();
    const double off_deg = std::acos(std::min(sine, 1.0)) * 180 / std::numbers::pi;
    EXPECT_GT(found.turn_deg, 0);
    EXPECT_LT(off_deg, 5 * found.turn_deg) << type_name(found.surface.type);
    EXPECT_LT(found.turn_deg, found.surface.type == SurfaceType::plane ? 0.3 : 2);
  }
}

TEST(DetectSurfaces, TakesFacesInOnePlaneForOne) {
  // Three blocks on a base, equally high.
  PrimitiveSet primitives{test::placed("base", Box{{8, 2, 1}}, {0, 0, 0})};
  for (const double x : {-2.5, 0.0, 2.5}) primitives.push_back(test::placed("block", Box{{1, 1, 1}}, {x, 0, 1}));
  const CsgTree tree = unite_all(std::vector{CsgTree::leaf(0), CsgTree::leaf(1), CsgTree::leaf(2), CsgTree::leaf(3)});
  const Detection detection = detect(cloud_of({primitives, tree}, 0.005, 40'000), 0.005);
  // Six of the base, the tops, two across for all blocks, two along for each.
  EXPECT_EQ(detection.surfaces.size(), 15U);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), 15U);
}

TEST(DetectSurfaces, KeepsTheFacesOfAHexagonalPrism) {
  Polytope prism;
  for (int k = 0; k < 6; ++k) {
    const double angle = k * std::numbers::pi / 3;
    prism.planes.push_back({.normal = {std::cos(angle), std::sin(angle), 0}, .offset = 1});
  }
  prism.planes.push_back({.normal = {0, 0, 1}, .offset = 1});
  prism.planes.push_back({.normal = {0, 0, -1}, .offset = 1});
  const PrimitiveSet primitives{test::placed("nut", prism, {0, 0, 0})};
  for (const double noise : {0.0, 0.006}) {
    const Detection detection = detect(cloud_of({primitives, CsgTree::leaf(0)}, noise), noise);
    EXPECT_EQ(count_of(detection, SurfaceType::plane), 8U);
    EXPECT_EQ(detection.surfaces.size(), 8U);
  }
}

/// An exact surface is not one with the next, although they are nearer than the form error of a mesh.
TEST(DetectSurfaces, TellsTwoFacesAtAThinStepApart) {
  PrimitiveSet primitives{test::placed("block", Box{{4, 3, 1}}, {0, 0, 0}),
                          test::placed("step", Box{{2, 4, 1}}, {1.5, 0, 0.995})};
  const test::Part part = test::without_others(std::move(primitives));
  const Detection detection = detect(cloud_of(part, 0), 0);
  EXPECT_GT(detection.distance_tolerance, 0.005);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), 7U);
  EXPECT_EQ(detection.surfaces.size(), 7U);  // the riser is too low to be a surface
}

/// A bar with a thicker half, without normals.
PointCloud noisy_step(double height, double noise, std::uint64_t seed) {
  const PrimitiveSet boxes{test::placed("bar", Box{{1, 0.3, 0.3}}, {0, 0, 0}),
                           test::placed("step", Box{{0.5, 0.3, 0.3}}, {0.25, 0, height})};
  PointCloud cloud = sample_surface(
      {.primitives = boxes, .tree = height == 0 ? CsgTree::leaf(0) : unite(CsgTree::leaf(0), CsgTree::leaf(1))},
      {.count = 14'000, .noise = noise, .seed = seed});
  cloud.normals = {};
  return cloud;
}

Detection detect_prepared(const PointCloud& cloud, const DetectOptions& options = {}) {
  const PreparedCloud prepared = prepare_cloud(cloud);
  return detect_surfaces(prepared.cloud, prepared.scale, options);
}

std::size_t planes_of(const PointCloud& cloud, const DetectOptions& options = {}) {
  const Detection detection = detect_prepared(cloud, options);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), detection.surfaces.size()) << "all surfaces are planes";
  return detection.surfaces.size();
}

/// Estimated normals turn from face to face along an edge, and its points may look like a narrow strip.
TEST(DetectSurfaces, FindsHardlyEverASurfaceAlongAnEdge) {
  int strips = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Detection detection = detect_prepared(noisy_step(0, 0.002, seed));
    EXPECT_GE(count_of(detection, SurfaceType::plane), 6U);
    strips += static_cast<int>(detection.surfaces.size()) - 6;
  }
  EXPECT_LE(strips, 1);
}

TEST(DetectSurfaces, FindsAStepWithinTheNoiseUnlessAToleranceIsGiven) {
  constexpr double k_noise = 0.002;
  const PointCloud cloud = noisy_step(3 * k_noise, k_noise, 1);
  EXPECT_GE(planes_of(cloud), 7U);
  EXPECT_EQ(planes_of(cloud, {.distance_tolerance = 3 * k_noise}), 6U);
}

TEST(DetectSurfaces, TakesAShortConeForNoSphere) {
  // A wide chamfer, which is within the form error of a sphere.
  const test::Part part{
      .primitives = {test::placed("cone", Cone{.radius_bottom = 2, .radius_top = 1.9, .height = 0.2}, {0, 0, 0}),
                     test::placed("shaft", Cylinder{1.5, 3}, {0, 0, -1.5})},
      .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
  const Detection detection = detect(cloud_of(part, 0), 0);
  ASSERT_EQ(count_of(detection, SurfaceType::cone), 1U);
  EXPECT_EQ(count_of(detection, SurfaceType::sphere), 0U);
  EXPECT_NEAR(by_radius(detection, SurfaceType::cone)[0].half_angle, std::atan(0.5), 1e-3);
}

TEST(DetectSurfaces, TakesAManyFacetedPrismForACylinder) {
  Polytope prism;
  constexpr int k_facets = 40;
  for (int k = 0; k < k_facets; ++k) {
    const double angle = 2 * std::numbers::pi * k / k_facets;
    prism.planes.push_back({.normal = {std::cos(angle), std::sin(angle), 0}, .offset = 1});
  }
  prism.planes.push_back({.normal = {0, 0, 1}, .offset = 1.5});
  prism.planes.push_back({.normal = {0, 0, -1}, .offset = 1.5});
  const PrimitiveSet primitives{test::placed("drum", prism, {0, 0, 0})};
  const Detection detection = detect(cloud_of({primitives, CsgTree::leaf(0)}, 0), 0);
  ASSERT_EQ(detection.surfaces.size(), 3U);
  EXPECT_EQ(count_of(detection, SurfaceType::cylinder), 1U);
}

TEST(DetectSurfaces, BearsOutliers) {
  PointCloud cloud = cloud_of(test::plate_with_holes(), 0.01, 30'000);
  RandomStream random(4);
  for (std::size_t i = 0; i < cloud.size(); i += 5) {
    cloud.positions.set(i, test::random_within(3, random));
    cloud.normals.set(i, test::random_direction(random));
  }
  expect_plate(detect(cloud, 0.01), 0.01);
}

TEST(DetectSurfaces, DoesNotDependOnUnitsOrPlace) {
  const PointCloud cloud = cloud_of(test::plate_with_holes(), 0.01);
  const Detection detection = detect(cloud, 0.01);
  for (const double scale : {0.003, 5000.0}) {
    PointCloud other = cloud;
    const Eigen::Vector3d offset = 1e5 * scale * Eigen::Vector3d(1, -2, 3);
    for (std::size_t i = 0; i < cloud.size(); ++i) other.positions.set(i, scale * cloud.positions[i] + offset);
    const Detection moved = detect(other, 0.01 * scale);
    ASSERT_EQ(moved.surfaces.size(), detection.surfaces.size());
    EXPECT_EQ(count_of(moved, SurfaceType::cylinder), count_of(detection, SurfaceType::cylinder));
    EXPECT_NEAR(by_radius(moved, SurfaceType::cylinder)[0].radius / scale,
                by_radius(detection, SurfaceType::cylinder)[0].radius, 1e-3);
  }
}

TEST(DetectSurfaces, GivesTheSameOnAnyNumberOfThreads) {
  const PointCloud cloud = cloud_of(test::block_with_pockets(), 0.01);
  const Detection one = detect(cloud, 0.01, {}, {.threads = 1});
  const Detection two = detect(cloud, 0.01, {}, {.threads = 2});
  ASSERT_EQ(one.surfaces.size(), two.surfaces.size());
  for (std::size_t k = 0; k < one.surfaces.size(); ++k) {
    EXPECT_EQ(one.surfaces[k].points, two.surfaces[k].points);
    EXPECT_EQ(one.surfaces[k].surface.position, two.surfaces[k].surface.position);
  }
}

TEST(DetectSurfaces, TellsHowManyPointsAreExplained) {
  const PointCloud cloud = cloud_of(test::plate_with_holes(), 0.01);
  std::vector<std::size_t> done;
  const RunContext run{.on_progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.unit, "points");
    EXPECT_EQ(progress.total, cloud.size());
    done.push_back(progress.done);
  }};
  EXPECT_EQ(detect(cloud, 0.01, {}, run).surfaces.size(), 9U);
  EXPECT_GT(done.size(), 9U);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.back(), cloud.size());
}

TEST(DetectSurfaces, SharesThePointsOut) {
  const PointCloud cloud = cloud_of(test::block_with_pockets(), 0.02);
  const Detection detection = detect(cloud, 0.02);
  std::vector<int> owners(cloud.size(), 0);
  for (const DetectedSurface& s : detection.surfaces) {
    EXPECT_TRUE(std::is_sorted(s.points.begin(), s.points.end()));
    for (const std::uint32_t i : s.points) {
      ++owners[i];
      EXPECT_LE(std::abs(signed_distance(s.surface, cloud.positions[i])), 1.01 * detection.distance_tolerance);
    }
  }
  EXPECT_LE(*std::max_element(owners.begin(), owners.end()), 1);
  EXPECT_EQ(static_cast<std::size_t>(std::count(owners.begin(), owners.end(), 0)), detection.unexplained);
}

/// A boss of three rows of points, between a disc and the plate around it. The first and the last row lie on the
/// planes; the normals of the other are useless, as are those that are estimated from twenty neighbours.
TEST(DetectSurfaces, FindsANarrowBandBetweenTwoFaces) {
  constexpr double k_row = 0.13;  // about the distance of the points in a row
  PointCloud cloud;
  RandomStream random(2);
  const auto ring = [&](double radius, double height) {
    const int count = std::max(1, static_cast<int>(2 * std::numbers::pi * radius / k_row));
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.37 * height) / count;
      cloud.positions.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
      cloud.normals.push_back(height == k_row ? test::random_direction(random) : Eigen::Vector3d::UnitZ());
    }
  };
  for (int k = 0; k <= 8; ++k) ring(k * k_row, 2 * k_row);
  ring(8 * k_row, k_row);
  for (int k = 8; k <= 30; ++k) ring(k * k_row, 0);
  const Detection detection = detect(cloud, 0);
  const std::vector<Surface> bands = by_radius(detection, SurfaceType::cylinder);
  ASSERT_EQ(bands.size(), 1U);
  EXPECT_NEAR(bands[0].radius, 8 * k_row, 1e-6);
  EXPECT_FALSE(bands[0].concave);
  EXPECT_EQ(detection.surfaces.size(), 3U);
  EXPECT_EQ(detection.unexplained, 0U);
}

/// Ten points of an exact plane are no chance; in noise that exceeds the spacing, they are.
TEST(DetectSurfaces, NeedsMorePointsInMoreNoise) {
  const auto patch = [](double noise) {
    RandomStream random(5);
    PointCloud cloud;
    const auto add = [&](const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
      cloud.positions.push_back(position + noise * random.normal() * normal);
      cloud.normals.push_back(normal);
    };
    for (int i = 0; i < 2000; ++i) add({random.uniform(-1, 1), random.uniform(-1, 1), 0}, {0, 0, 1});
    for (int i = 0; i < 10; ++i) add({random.uniform(0.9, 1), 1.1, random.uniform(0.2, 0.3)}, {0, 1, 0});
    return cloud;
  };
  const auto found = [&](double noise) {
    const PointCloud cloud = patch(noise);
    const Scale scale{.box = bounds_of(cloud.positions), .diagonal = 2.9, .spacing = 0.045, .noise = noise};
    return detect_surfaces(cloud, scale).surfaces.size();
  };
  EXPECT_EQ(found(0), 2U);
  EXPECT_EQ(found(0.02), 1U);
}

TEST(DetectSurfaces, FindsNothingInAFogOfPoints) {
  RandomStream random(9);
  PointCloud cloud;
  for (int i = 0; i < 5000; ++i) {
    cloud.positions.push_back(test::random_within(1, random));
    cloud.normals.push_back(test::random_direction(random));
  }
  EXPECT_TRUE(detect(cloud, 0).surfaces.empty());
}

TEST(DetectSurfaces, LeavesSmallSurfacesAloneWhenAskedTo) {
  const PointCloud cloud = cloud_of(test::plate_with_holes(), 0.005);
  const Detection detection = detect(cloud, 0.005, {.least_points = 3000});
  EXPECT_EQ(detection.surfaces.size(), 2U);
  for (const DetectedSurface& s : detection.surfaces) EXPECT_GE(s.points.size(), 3000U);
}

TEST(DetectSurfaces, CanBeStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)detect(cloud_of(test::plate_with_holes(), 0), 0, {}, {.stop = stop.get_token()}), Cancelled);
}

TEST(DetectSurfaces, PassesOverWhatIsSmallerOrLargerThanAllowed) {
  const PointCloud cloud = cloud_of(test::plate_with_holes(), 0.005);
  // Holes of radius 0.3, 0.4 and 0.5 in a plate of 4 x 3 x 0.6.
  const Detection large_only = detect(cloud, 0.005, {.least_size = 0.35});
  EXPECT_EQ(count_of(large_only, SurfaceType::plane), 6U);
  ASSERT_EQ(count_of(large_only, SurfaceType::cylinder), 2U);
  EXPECT_NEAR(by_radius(large_only, SurfaceType::cylinder)[0].radius, 0.4, 0.01);
  EXPECT_GT(large_only.unexplained, 0U);

  // Top and bottom reach over 5.
  const Detection small_only = detect(cloud, 0.005, {.most_size = 4.5});
  EXPECT_EQ(count_of(small_only, SurfaceType::plane), 4U);
  EXPECT_EQ(count_of(small_only, SurfaceType::cylinder), 3U);
  for (const DetectedSurface& found : small_only.surfaces) {
    EXPECT_TRUE(found.surface.type != SurfaceType::plane || std::abs(found.surface.axis.z()) < 0.1);
  }
}

TEST(DetectSurfaces, LimitsOfSizeAreInTheUnitsOfTheCloud) {
  PointCloud cloud = cloud_of(test::plate_with_holes(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.positions.set(i, 50 * cloud.positions[i]);
  EXPECT_EQ(count_of(detect(cloud, 0, {.least_size = 17.5}), SurfaceType::cylinder), 2U);
}

TEST(DetectSurfaces, RefusesLimitsThatLeaveNothing) {
  const PointCloud cloud = cloud_of(test::plate_with_holes(), 0, 500);
  EXPECT_THROW((void)detect(cloud, 0, {.least_size = 2, .most_size = 1}), Error);
  EXPECT_THROW((void)detect(cloud, 0, {.least_size = 0}), Error);
  EXPECT_THROW((void)detect(cloud, 0, {.most_size = std::numeric_limits<double>::infinity()}), Error);
}

}  // namespace
}  // namespace cloud2csg
