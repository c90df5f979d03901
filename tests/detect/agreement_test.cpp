#include "raw/detect/agreement.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "raw/detect/propose.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_types{SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone,
                             SurfaceType::torus};

Surface random_surface(SurfaceType type, RandomStream& random) {
  const double minor = random.uniform(0.1, 0.4);
  return {.type = type,
          .position = test::random_within(1, random),
          .axis = test::random_direction(random),
          .radius = random.uniform(0.5, 2),
          .half_angle = random.uniform(0.2, 1.2),
          .minor_radius = minor,
          .concave = type != SurfaceType::plane && random.chance(0.5)};
}

/// A place on the surface: where a walk down the distance from a random place ends. Not the apex of a cone.
OrientedPoint random_point_on(const Surface& surface, RandomStream& random) {
  Eigen::Vector3d x = surface.position + test::random_within(2, random);
  if (surface.type == SurfaceType::cone)
    x = surface.position + random.uniform(0.6, 2) * surface.axis + test::random_within(0.4, random);
  for (int step = 0; step < 3; ++step) x -= signed_distance(surface, x) * normal(surface, x);
  return {.position = x, .normal = normal(surface, x)};
}

RC_GTEST_PROP(WithAgreement, IsDistanceAndNormalOfTheSurface, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  for (const SurfaceType type : k_types) {
    const Surface surface = random_surface(type, random);
    const Eigen::Vector3d place = test::random_within(2, random);
    const Eigen::Vector3d direction = test::random_direction(random);
    const Agreement agreement = with_agreement(surface, [&](const auto& rule) -> Agreement {
      return rule({place, direction});
    });
    RC_ASSERT(std::abs(agreement.distance - signed_distance(surface, place)) < 1e-12);
    RC_ASSERT(std::abs(agreement.cosine - normal(surface, place).dot(direction)) < 1e-9);
  }
}

RC_GTEST_PROP(ForEachAgreeing, FindsThePointsThatAPlainLoopFinds, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  PointCloud cloud;
  for (const SurfaceType type : k_types) {
    const Surface surface = random_surface(type, random);
    for (int k = 0; k < 300; ++k) {
      const OrientedPoint point = random_point_on(surface, random);
      cloud.positions.push_back(point.position + test::random_within(0.01, random));
      cloud.normals.push_back(point.normal);
    }
  }
  WorkCloud work = make_work_cloud(cloud);
  if (random.chance(0.5)) {
    for (OrientedPoint& point : work.points) point.precision = random.uniform(0.1, 1);
    work.runs = runs_of(work.points);
  }
  for (const SurfaceType type : k_types) {
    Surface surface = random_surface(type, random);
    if (random.chance(0.5))
      surface.position = work.runs[random.below(work.runs.size())].middle;  // where a distance has no gradient
    const AgreementLimits limits{
        .distance = random.uniform(0.001, 0.1), .noise = 0.001, .cosine = random.uniform(-1, 1)};
    const auto is_odd = [](std::uint32_t i) { return i % 2 == 1; };
    std::vector<std::uint32_t> plain;
    std::vector<std::uint32_t> fast;
    with_agreement(surface, [&](const auto& rule) {
      for (std::uint32_t i = 0; i < work.size(); ++i) {
        if (is_odd(i) && limits.hold(rule(work.points[i]))) plain.push_back(i);
      }
    });
    for_each_agreeing(surface, work, limits, is_odd, [&](std::uint32_t i, const Agreement&) { fast.push_back(i); });
    RC_ASSERT(fast == plain);
  }
}

template <std::size_t Count>
std::array<OrientedPoint, Count> points_on(const Surface& surface, RandomStream& random) {
  std::array<OrientedPoint, Count> points;
  for (OrientedPoint& point : points) point = random_point_on(surface, random);
  return points;
}

/// Whether normals differ enough to determine what is asked for.
template <std::size_t Count>
bool are_spread(const std::array<OrientedPoint, Count>& points) {
  for (std::size_t i = 0; i < Count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (points[i].normal.cross(points[j].normal).norm() < 0.2) return false;
    }
  }
  return true;
}

void expect_through(const std::optional<Surface>& found, const Surface& truth, RandomStream& random) {
  RC_ASSERT(found.has_value());
  RC_ASSERT(found->concave == truth.concave);
  for (int k = 0; k < 5; ++k) {
    const OrientedPoint other = random_point_on(truth, random);
    RC_ASSERT(std::abs(signed_distance(*found, other.position)) < 1e-6);
    RC_ASSERT(normal(*found, other.position).dot(other.normal) > 1 - 1e-6);
  }
}

RC_GTEST_PROP(MinimalSurfaces, GoThroughAllOfTheSurfaceTheirPointsAreOn, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const Surface sphere = random_surface(SurfaceType::sphere, random);
  if (const auto points = points_on<2>(sphere, random); are_spread(points)) {
    expect_through(sphere_through(points), sphere, random);
  }
  const Surface cylinder = random_surface(SurfaceType::cylinder, random);
  if (const auto points = points_on<2>(cylinder, random); are_spread(points)) {
    expect_through(cylinder_through(points), cylinder, random);
  }
  const Surface plane = random_surface(SurfaceType::plane, random);
  const auto on_plane = points_on<3>(plane, random);
  if (const auto found = plane_through(on_plane)) expect_through(found, plane, random);
}

/// Whether the rulings through the points differ enough to determine the axis: those of a narrow cone may not, even
/// where its normals do.
bool rulings_are_spread(const Surface& cone, const std::array<OrientedPoint, 3>& points) {
  const auto ruling = [&](std::size_t i) -> Eigen::Vector3d {
    return (points[i].position - cone.position).normalized();
  };
  return (ruling(1) - ruling(0)).cross(ruling(2) - ruling(0)).norm() > 0.01;
}

RC_GTEST_PROP(MinimalSurfaces, FindTheConeOfThreePoints, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const Surface cone = random_surface(SurfaceType::cone, random);
  const auto points = points_on<3>(cone, random);
  RC_PRE(are_spread(points) && rulings_are_spread(cone, points));
  expect_through(cone_through(points), cone, random);
}

TEST(MinimalSurfaces, AreNoneWherePointsDetermineNone) {
  const OrientedPoint a{.position = {0, 0, 0}, .normal = {0, 0, 1}};
  const OrientedPoint b{.position = {1, 0, 0}, .normal = {0, 0, 1}};
  const OrientedPoint c{.position = {2, 0, 0}, .normal = {0, 0, 1}};
  EXPECT_FALSE(sphere_through(std::array{a, b}));
  EXPECT_FALSE(cylinder_through(std::array{a, b}));
  EXPECT_FALSE(plane_through(std::array{a, b, c}));
  EXPECT_FALSE(cone_through(std::array{a, b, c}));
}

}  // namespace
}  // namespace cloud2csg
