#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "cloud2csg/primitive.hpp"
#include "primitive/displacement-inl.hpp"
#include "primitive/random_primitives.hpp"
#include "support/forced_target.hpp"

namespace cloud2csg {
namespace {

using test::ForcedTarget;
using testing::any_primitive;
using testing::points_near;

struct Evaluated {
  std::vector<double> distance;
  Points slope;
};

Evaluated fast_field(const Primitive& primitive, PointsView points) {
  Evaluated result{.distance = std::vector<double>(points.size()), .slope = Points(points.size())};
  evaluate_field(primitive, points,
                 {.distance = result.distance,
                  .gradient_x = result.slope.x,
                  .gradient_y = result.slope.y,
                  .gradient_z = result.slope.z});
  return result;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

bool same_bits(const Evaluated& a, const Evaluated& b) {
  return same_bits(a.distance, b.distance) && same_bits(a.slope.x, b.slope.x) && same_bits(a.slope.y, b.slope.y) &&
         same_bits(a.slope.z, b.slope.z);
}

/// Random points, and a few on the loci where comparisons are between equals and zeros have signs.
Points varied_points(const Primitive& primitive, std::size_t count) {
  Points points = points_near(primitive, count);
  for (std::size_t i = 0; i < count; i += 3) {
    constexpr std::array<double, 6> k_coordinates = {0.0, -0.0, 0.5, -0.5, 1.0, 1e-200};
    Eigen::Vector3d special;
    for (double& x : special) x = k_coordinates[static_cast<std::size_t>(testing::integer(0, 6))];
    points.set(i, primitive.pose.to_world(special));
  }
  return points;
}

TEST(EvaluateField, HasMoreThanOneInstructionSetToCompare) {
#if HWY_ARCH_X86_64
  EXPECT_GT(hwy::SupportedAndGeneratedTargets().size(), 1U);
#endif
}

RC_GTEST_PROP(EvaluateField, IsBitForBitThePlainReferenceOnEveryInstructionSet, ()) {
  const Primitive primitive = any_primitive();
  const Points points = varied_points(primitive, static_cast<std::size_t>(testing::integer(0, 71)));
  const Evaluated plain{.distance = signed_distance(primitive, points), .slope = gradient(primitive, points)};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const ForcedTarget forced(target);
    if (!same_bits(fast_field(primitive, points), plain)) RC_FAIL(std::string(hwy::TargetName(target)));
  }
}

TEST(EvaluateField, HandlesEveryLengthAndWritesNothingBeyond) {
  const Primitive primitive{.id = "c",
                            .shape = Cone{1, 0.5, 2},
                            .pose = {.position = {0.1, 0.2, 0.3}, .orientation = {0.5, 0.5, 0.5, 0.5}},
                            .displacement = Displacement{3}};
  for (std::size_t count = 0; count <= 70; ++count) {
    Points points(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto t = static_cast<double>(i);
      points.set(i, {std::sin(t), std::cos(2 * t), std::sin(3 * t)});
    }
    std::vector<double> memory(4 * (count + 1), 42.0);
    const auto row = [&](std::size_t i) { return std::span(memory).subspan(i * (count + 1), count); };
    evaluate_field(primitive, points,
                   {.distance = row(0), .gradient_x = row(1), .gradient_y = row(2), .gradient_z = row(3)});
    const std::vector<double> expected = signed_distance(primitive, points);
    EXPECT_TRUE(same_bits({row(0).begin(), row(0).end()}, expected)) << count;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(memory[i * (count + 1) + count], 42.0) << count;
  }
}

TEST(EvaluateField, MayRunInSeveralThreads) {
  const Primitive primitive{
      .id = "e",
      .shape = Expression{"sqrt(x^2+y^2+z^2)-1", AlignedBox(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1))}};
  Points points(200);
  for (std::size_t i = 0; i < points.size(); ++i)
    points.set(i, Eigen::Vector3d::Constant(0.01 * static_cast<double>(i)));
  const Evaluated expected = fast_field(primitive, points);
  std::vector<Evaluated> results(4);
  std::vector<std::thread> threads;
  threads.reserve(results.size());
  for (Evaluated& result : results) threads.emplace_back([&] { result = fast_field(primitive, points); });
  for (std::thread& thread : threads) thread.join();
  for (const Evaluated& result : results) EXPECT_TRUE(same_bits(result, expected));
}

const HWY_NAMESPACE::SineCosineFormula<HWY_NAMESPACE::PlainTag> k_sine_cosine{HWY_NAMESPACE::PlainTag()};

RC_GTEST_PROP(SineCosine, AgreesWithTheLibrary, ()) {
  const double x = testing::real(-1, 1) * std::pow(10.0, testing::integer(-8, 5));
  const auto [sine, cosine] = k_sine_cosine.at(x);
  RC_ASSERT(std::abs(sine - std::sin(x)) <= 1e-15);
  RC_ASSERT(std::abs(cosine - std::cos(x)) <= 1e-15);
}

TEST(SineCosine, StaysWithinOneForAnyAngle) {
  for (const double x : {1e6, 1e9, 1e15, 1e17, 1e100, std::numeric_limits<double>::max()}) {
    const auto [sine, cosine] = k_sine_cosine.at(x);
    EXPECT_LE(std::abs(sine), 1.0) << x;
    EXPECT_LE(std::abs(cosine), 1.0) << x;
  }
}

}  // namespace
}  // namespace cloud2csg
