#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "surface/patches.hpp"

namespace cloud2csg {
namespace {

constexpr double k_noise = 0.005 * test::k_patch_size;
constexpr int k_repeats = 8;

/// Half of the surfaces are concave.
struct Case {
  Surface truth;
  test::Patch patch;
};

Case make_case(SurfaceType type, int repeat, const test::PatchOptions& options, double far = 0) {
  RandomStream random(static_cast<std::uint64_t>(repeat), static_cast<std::uint64_t>(type));
  const Surface truth = test::random_surface(type, random, repeat % 2 == 1, far);
  return {truth, test::sample_patch(truth, options, random)};
}

class EachSurface : public testing::TestWithParam<SurfaceType> {
 protected:
  /// Estimates, fits, and holds the fit against the truth.
  static void expect_recovered(const test::PatchOptions& options, double tolerance, double far = 0) {
    for (int repeat = 0; repeat < k_repeats; ++repeat) {
      const Case sample = make_case(GetParam(), repeat, options, far);
      const auto start = estimate_surface(GetParam(), sample.patch.points, sample.patch.normals);
      ASSERT_TRUE(start) << "repeat " << repeat;
      const auto fit = fit_surface(*start, sample.patch.points);
      ASSERT_TRUE(fit) << "repeat " << repeat;
      EXPECT_LT(test::largest_distance(fit->surface, sample.truth, options), tolerance) << "repeat " << repeat;
      EXPECT_EQ(fit->surface.type, GetParam());
      EXPECT_EQ(fit->surface.concave, sample.truth.concave);
      EXPECT_NEAR(fit->surface.axis.norm(), 1, 1e-12);
      EXPECT_NEAR(fit->rms, options.noise, 0.1 * options.noise + 1e-9 * (1 + far / 10));
    }
  }
};

TEST_P(EachSurface, IsRecoveredFromExactPoints) {
  expect_recovered({.count = 500}, 1e-9);
}

TEST_P(EachSurface, IsRecoveredFromNoisyPoints) {
  expect_recovered({.noise = k_noise, .normal_noise = 0.05}, 0.35 * k_noise);
}

TEST_P(EachSurface, IsRecoveredFromASixthOfATurn) {
  expect_recovered({.arc_deg = 60, .noise = k_noise, .normal_noise = 0.05}, 0.6 * k_noise);
}

TEST_P(EachSurface, IsRecoveredFromAShortStrip) {
  expect_recovered({.arc_deg = 180, .length = 0.2, .noise = k_noise, .normal_noise = 0.05}, 0.6 * k_noise);
}

TEST_P(EachSurface, IsRecoveredFarFromTheOrigin) {
  expect_recovered({.count = 500}, 1e-8, 1e6);
  expect_recovered({.noise = k_noise, .normal_noise = 0.05}, 0.35 * k_noise, 1e6);
}

TEST_P(EachSurface, IsRecoveredAmongOutliers) {
  const test::PatchOptions options{.noise = k_noise, .outlier_share = 0.2};
  for (int repeat = 0; repeat < k_repeats; ++repeat) {
    const Case sample = make_case(GetParam(), repeat, options);
    RandomStream random(5, static_cast<std::uint64_t>(repeat));
    const auto fit = fit_surface(test::shaken(sample.truth, 0.1, random), sample.patch.points);
    ASSERT_TRUE(fit);
    EXPECT_LT(test::largest_distance(fit->surface, sample.truth, options), 0.5 * k_noise) << "repeat " << repeat;
    EXPECT_NEAR(fit->noise, k_noise, 0.4 * k_noise);
    EXPECT_GT(fit->inliers, 0.78 * static_cast<double>(options.count));
    EXPECT_LT(fit->inliers, 0.85 * static_cast<double>(options.count));
  }
}

TEST_P(EachSurface, IsHeldByTheGivenNoiseAgainstMoreOutliersThanPoints) {
  const test::PatchOptions options{.noise = k_noise, .outlier_share = 0.55};
  for (int repeat = 0; repeat < k_repeats; ++repeat) {
    const Case sample = make_case(GetParam(), repeat, options);
    RandomStream random(6, static_cast<std::uint64_t>(repeat));
    const auto fit = fit_surface(test::shaken(sample.truth, 0.02, random), sample.patch.points, {.noise = k_noise});
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->noise, k_noise);
    EXPECT_LT(test::largest_distance(fit->surface, sample.truth, options), k_noise) << "repeat " << repeat;
  }
}

/// The fit of moved and scaled points is the moved and scaled fit.
TEST_P(EachSurface, IsTheSameInAnyFrame) {
  const test::PatchOptions options{.count = 400, .noise = k_noise, .normal_noise = 0.02};
  for (const double scale : {1e-4, 1.0, 1e4}) {
    const Case sample = make_case(GetParam(), 3, options);
    const Pose motion{.position = {12, -30, 7}, .orientation = Eigen::Quaterniond(1, 2, -1, 0.5).normalized()};
    const auto moved = [&](const Eigen::Vector3d& point) { return Eigen::Vector3d(scale * motion.to_world(point)); };
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3d& point : sample.patch.points) points.push_back(moved(point));
    Surface start = sample.truth;
    start.position = moved(start.position);
    start.axis = motion.orientation * start.axis;
    start.radius *= scale;
    start.minor_radius *= scale;
    const auto here = fit_surface(sample.truth, sample.patch.points);
    const auto there = fit_surface(start, points);
    ASSERT_TRUE(here && there);
    EXPECT_NEAR(there->rms, scale * here->rms, 1e-4 * scale * here->rms);
    for (const Eigen::Vector3d& point : sample.patch.points) {
      EXPECT_NEAR(signed_distance(there->surface, moved(point)), scale * signed_distance(here->surface, point),
                  1e-3 * scale * k_noise);
    }
  }
}

/// Errors in units of what is said of them, over many fits: about one.
TEST_P(EachSurface, KnowsHowUncertainItIs) {
  const test::PatchOptions options{.count = 300, .arc_deg = 120, .noise = k_noise};
  double axis = 0;
  double radius = 0;
  double half_angle = 0;
  double minor_radius = 0;
  constexpr int k_fits = 40;
  const auto square = [](double error, double deviation) { return deviation > 0 ? std::pow(error / deviation, 2) : 1; };
  for (int repeat = 0; repeat < k_fits; ++repeat) {
    const Case sample = make_case(GetParam(), repeat, options);
    const auto fit = fit_surface(sample.truth, sample.patch.points);
    ASSERT_TRUE(fit);
    EXPECT_GT(fit->uncertainty.position, 0);
    axis += square(test::axis_angle(fit->surface, sample.truth), fit->uncertainty.axis) / k_fits;
    const bool has_radius = GetParam() != SurfaceType::cone;
    radius += square(fit->surface.radius - sample.truth.radius, has_radius ? fit->uncertainty.radius : 0) / k_fits;
    half_angle += square(fit->surface.half_angle - sample.truth.half_angle, fit->uncertainty.half_angle) / k_fits;
    minor_radius +=
        square(fit->surface.minor_radius - sample.truth.minor_radius, fit->uncertainty.minor_radius) / k_fits;
  }
  for (const double mean_square : {axis, radius, half_angle, minor_radius}) {
    EXPECT_GT(mean_square, 0.5);
    EXPECT_LT(mean_square, 2.2);
  }
}

TEST_P(EachSurface, KeepsItsDirectionOrAxisAndFindsTheRest) {
  const test::PatchOptions options{.arc_deg = 60, .length = 0.3, .noise = k_noise};
  double off_alone = 0;
  double off_held = 0;
  for (int repeat = 0; repeat < k_repeats; ++repeat) {
    const Case sample = make_case(GetParam(), repeat, options);
    const auto alone = fit_surface(sample.truth, sample.patch.points);
    ASSERT_TRUE(alone);
    Surface start = sample.truth;
    start.position += 3 * k_noise * start.axis.unitOrthogonal();
    start.radius += 2 * k_noise;
    const auto turned = fit_surface(start, sample.patch.points, {.held = HeldValue::direction});
    ASSERT_TRUE(turned);
    EXPECT_LT((turned->surface.axis - start.axis).norm(), 1e-12);
    EXPECT_EQ(turned->uncertainty.axis, 0);
    EXPECT_LE(turned->rms, 1.1 * alone->rms);
    EXPECT_LE(turned->uncertainty.position, 1.1 * alone->uncertainty.position);
    off_alone += (alone->surface.position - sample.truth.position).norm();
    off_held += (turned->surface.position - sample.truth.position).norm();

    const auto moved = fit_surface(start, sample.patch.points, {.held = HeldValue::axis});
    ASSERT_TRUE(moved);
    EXPECT_LE(moved->uncertainty.radius, 1.1 * alone->uncertainty.radius);
    const Eigen::Vector3d offset = moved->surface.position - start.position;
    if (GetParam() == SurfaceType::plane || GetParam() == SurfaceType::sphere) continue;
    EXPECT_LT((moved->surface.axis - start.axis).norm(), 1e-12);
    EXPECT_LT(offset.cross(start.axis).norm(), 1e-9) << "it stays on its axis";
  }
  EXPECT_LE(off_held, 1.01 * off_alone) << "a known direction tells where it is";
}

TEST_P(EachSurface, NeedsAsManyPointsAsUnknowns) {
  const Case sample = make_case(GetParam(), 0, {.count = 7});
  const std::size_t unknowns = std::array<std::size_t, 5>{3, 4, 5, 6, 7}[static_cast<std::size_t>(GetParam())];
  const std::span<const Eigen::Vector3d> points(sample.patch.points);
  EXPECT_TRUE(fit_surface(sample.truth, points.first(unknowns)));
  EXPECT_FALSE(fit_surface(sample.truth, points.first(unknowns - 1)));
}

/// Whatever the points: what comes back is a surface.
RC_GTEST_PROP(FitSurface, BearsWithAnyPoints, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const auto count = *rc::gen::inRange<std::size_t>(0, 40);
  const int dimensions = *rc::gen::inRange(0, 4);
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d point = test::random_within(1, random);
    for (int k = dimensions; k < 3; ++k) point[k] = 0.25;
    points.push_back(point);
    normals.push_back(random.chance(0.5) ? test::random_direction(random) : Eigen::Vector3d::UnitY());
  }
  for (const SurfaceType type : test::k_surface_types) {
    const auto start = estimate_surface(type, points, normals);
    const auto fit = fit_surface(start.value_or(test::random_surface(type, random)), points);
    if (!fit) continue;
    RC_ASSERT(fit->surface.position.allFinite());
    RC_ASSERT(std::abs(fit->surface.axis.norm() - 1) < 1e-9);
    RC_ASSERT(std::isfinite(fit->rms));
    RC_ASSERT(fit->inliers <= count);
    if (type == SurfaceType::sphere || type == SurfaceType::cylinder) RC_ASSERT(fit->surface.radius > 0);
    if (type == SurfaceType::cone) RC_ASSERT(fit->surface.half_angle > 0 && fit->surface.half_angle < 1.5708);
  }
}

TEST_P(EachSurface, FollowsThePrecisePoints) {
  double off = 0;
  double off_if_equal = 0;
  for (int repeat = 0; repeat < k_repeats; ++repeat) {
    Case sample = make_case(GetParam(), repeat, {.noise = k_noise});
    RandomStream random(static_cast<std::uint64_t>(repeat));
    std::vector<double> precisions;
    for (Eigen::Vector3d& point : sample.patch.points) {
      precisions.push_back(random.chance(0.5) ? 1 : 0.1);
      if (precisions.back() < 1) point += 10 * k_noise * random.normal() * normal(sample.truth, point);
    }
    const auto fit = fit_surface(sample.truth, sample.patch.points, {.precisions = precisions});
    const auto equal = fit_surface(sample.truth, sample.patch.points);
    ASSERT_TRUE(fit && equal);
    EXPECT_NEAR(fit->noise, k_noise, 0.15 * k_noise);
    off += test::largest_distance(fit->surface, sample.truth, {});
    off_if_equal += test::largest_distance(equal->surface, sample.truth, {});
  }
  EXPECT_LT(off, 0.7 * off_if_equal);
}

TEST_P(EachSurface, OfEqualPrecisionsIsThatOfTheirNoise) {
  const Case sample = make_case(GetParam(), 1, {.noise = k_noise});
  const std::vector<double> precisions(sample.patch.points.size(), 0.25);
  const auto fit = fit_surface(sample.truth, sample.patch.points, {.noise = k_noise / 4, .precisions = precisions});
  const auto plain = fit_surface(sample.truth, sample.patch.points, {.noise = k_noise});
  ASSERT_TRUE(fit && plain);
  EXPECT_LT(test::largest_distance(fit->surface, plain->surface, {}), 1e-9);
  EXPECT_EQ(fit->inliers, plain->inliers);
  EXPECT_NEAR(fit->uncertainty.position, plain->uncertainty.position, 1e-6 * plain->uncertainty.position);
}

TEST(FitSurface, TakesSomeOfManyPoints) {
  const Case sample = make_case(SurfaceType::cylinder, 1, {.count = 9000, .noise = k_noise});
  const auto few = fit_surface(sample.truth, sample.patch.points, {.most_points = 300});
  const auto all = fit_surface(sample.truth, sample.patch.points, {.most_points = 9000});
  ASSERT_TRUE(few && all);
  EXPECT_GT(few->uncertainty.radius, 3 * all->uncertainty.radius);
  EXPECT_GT(few->inliers, 8900U) << "counts all points";
}

TEST(FitSurface, KeepsWhichWayAPlaneFaces) {
  for (int repeat = 0; repeat < k_repeats; ++repeat) {
    const Case sample = make_case(SurfaceType::plane, repeat, {.noise = k_noise, .normal_noise = 0.3});
    const auto start = estimate_surface(SurfaceType::plane, sample.patch.points, sample.patch.normals);
    ASSERT_TRUE(start);
    const auto fit = fit_surface(*start, sample.patch.points);
    ASSERT_TRUE(fit);
    EXPECT_GT(fit->surface.axis.dot(sample.truth.axis), 0.99);
  }
}

TEST(FitSurface, OfANarrowConeIsNearlyACylinder) {
  RandomStream random(2);
  const Surface cylinder = test::random_surface(SurfaceType::cylinder, random);
  const test::Patch patch = test::sample_patch(cylinder, {.noise = k_noise}, random);
  const Surface start{.type = SurfaceType::cone,
                      .position = cylinder.position - 10 * cylinder.axis,
                      .axis = cylinder.axis,
                      .half_angle = 0.08};
  const auto fit = fit_surface(start, patch.points);
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->surface.half_angle, 5 * fit->uncertainty.half_angle);
  EXPECT_LT(test::largest_distance(fit->surface, cylinder, {}), k_noise);
}

TEST(EstimateSurface, FindsToriWhoseTubeCrossesTheAxis) {
  RandomStream random(4);
  for (const double radius : {0.4, 0.2, -0.2, -0.4}) {
    for (const double noise : {0.0, k_noise}) {
      const Surface truth{.type = SurfaceType::torus,
                          .position = test::random_within(1, random),
                          .axis = test::random_direction(random),
                          .radius = radius,
                          .minor_radius = 0.8,
                          .concave = noise > 0};
      const test::Patch patch = test::sample_patch(truth, {.noise = noise, .normal_noise = 5 * noise}, random);
      const auto start = estimate_surface(SurfaceType::torus, patch.points, patch.normals);
      ASSERT_TRUE(start) << radius;
      const auto fit = fit_surface(*start, patch.points);
      ASSERT_TRUE(fit) << radius;
      EXPECT_NEAR(fit->surface.radius, radius, 1e-9 + noise);
      EXPECT_NEAR(fit->surface.minor_radius, 0.8, 1e-9 + noise);
      EXPECT_EQ(fit->surface.concave, truth.concave);
      EXPECT_LT(test::largest_distance(fit->surface, truth, {}), 1e-9 + 0.5 * noise) << radius;
    }
  }
}

TEST(EstimateSurface, RefusesWhatPointsDoNotDetermine) {
  std::vector<Eigen::Vector3d> line;
  std::vector<Eigen::Vector3d> flat;
  RandomStream random(7);
  for (int i = 0; i < 50; ++i) {
    line.emplace_back(0.1 * i, 0.2 * i, -0.3 * i);
    flat.emplace_back(random.uniform(), random.uniform(), 0);
  }
  const std::vector<Eigen::Vector3d> up(50, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(estimate_surface(SurfaceType::plane, line, up));
  for (const SurfaceType type : {SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus}) {
    EXPECT_FALSE(estimate_surface(type, flat, up)) << type;
    EXPECT_FALSE(estimate_surface(type, {}, {})) << type;
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, EachSurface, testing::ValuesIn(test::k_surface_types),
                         [](const auto& type) { return std::string(type_name(type.param)); });

}  // namespace
}  // namespace cloud2csg
