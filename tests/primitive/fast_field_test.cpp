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
#include "core/primitive/displacement-inl.hpp"
#include "core/primitive/sampled_field.hpp"
#include "primitive/random_primitives.hpp"
#include "support/forced_target.hpp"

namespace cloud2csg {
namespace {

using test::ForcedTarget;
using testing::any_primitive;
using testing::points_near;

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  }
  return true;
}

bool same_bits(const SampledField& a, const SampledField& b) {
  return same_bits(a.distances, b.distances) && same_bits(a.slopes.x, b.slopes.x) &&
         same_bits(a.slopes.y, b.slopes.y) && same_bits(a.slopes.z, b.slopes.z);
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
  const SampledField plain{.distances = signed_distance(primitive, points), .slopes = gradient(primitive, points)};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const ForcedTarget forced(target);
    if (!same_bits(sample_field(primitive, points), plain)) RC_FAIL(std::string(hwy::TargetName(target)));
    std::vector<double> distance(points.size());
    evaluate_distance(primitive, points, distance);
    if (!same_bits(distance, plain.distances)) RC_FAIL(std::string("distance only on ") + hwy::TargetName(target));
  }
}

struct SingleField {
  std::array<std::vector<float>, 7> columns;

  [[nodiscard]] BasicPointsView<float> points() const { return {columns[0], columns[1], columns[2]}; }
  [[nodiscard]] Eigen::Vector3d slope(std::size_t i) const {
    return Eigen::Vector3f(columns[4][i], columns[5][i], columns[6][i]).cast<double>();
  }
};

/// At the points, rounded to single precision.
SingleField single_field(const Primitive& primitive, const Points& points) {
  SingleField field;
  for (std::vector<float>& column : field.columns) column.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      field.columns[axis][i] = static_cast<float>(points[i][static_cast<Eigen::Index>(axis)]);
    }
  }
  evaluate_field(primitive, field.points(),
                 {.distance = field.columns[3],
                  .gradient_x = field.columns[4],
                  .gradient_y = field.columns[5],
                  .gradient_z = field.columns[6]});
  return field;
}

/// Whether the slope is nearly one that the field has at a point or right beside it, where it may be another.
bool is_slope_near(const Primitive& primitive, const Eigen::Vector3d& point, const Eigen::Vector3d& slope,
                   double step) {
  Points around;
  for (int k = 0; k < 27; ++k) {
    around.push_back(point + step * Eigen::Vector3d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
  }
  const Points slopes = gradient(primitive, around);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if ((slopes[i] - slope).norm() <= 1e-3 * (1 + slopes[i].norm())) return true;
  }
  return false;
}

RC_GTEST_PROP(EvaluateField, InSinglePrecisionIsNearTheDoubleOne, ()) {
  const Primitive primitive = any_primitive();
  const Points points = points_near(primitive, static_cast<std::size_t>(testing::integer(0, 71)));
  const SingleField field = single_field(primitive, points);
  Points rounded(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    rounded.set(i, Eigen::Vector3f(field.columns[0][i], field.columns[1][i], field.columns[2][i]).cast<double>());
  }
  const std::vector<double> distance = signed_distance(primitive, rounded);
  const OrientedBox box = oriented_bounds(primitive);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double size = box.half_size.allFinite() ? box.half_size.norm() : 0.0;
    const double scale = 1 + rounded[i].norm() + primitive.pose.position.norm() + size + std::abs(distance[i]);
    RC_ASSERT(std::abs(static_cast<double>(field.columns[3][i]) - distance[i]) <= 2e-6 * scale);
    RC_ASSERT(is_slope_near(primitive, rounded[i], field.slope(i), 1e-5 * scale));
  }
}

RC_GTEST_PROP(EvaluateField, InSinglePrecisionIsTheSameOnEveryInstructionSet, ()) {
  const Primitive primitive = any_primitive();
  const Points points = varied_points(primitive, static_cast<std::size_t>(testing::integer(0, 71)));
  const SingleField expected = single_field(primitive, points);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const ForcedTarget forced(target);
    if (single_field(primitive, points).columns != expected.columns) RC_FAIL(std::string(hwy::TargetName(target)));
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
  const SampledField expected = sample_field(primitive, points);
  std::vector<SampledField> results(4);
  std::vector<std::thread> threads;
  threads.reserve(results.size());
  for (SampledField& result : results) threads.emplace_back([&] { result = sample_field(primitive, points); });
  for (std::thread& thread : threads) thread.join();
  for (const SampledField& result : results) EXPECT_TRUE(same_bits(result, expected));
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
