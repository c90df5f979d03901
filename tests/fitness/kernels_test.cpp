#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/align/aligned_allocator.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "fitness/point_kernels.hpp"
#include "support/forced_target.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Keys = std::vector<std::uint64_t, boost::alignment::aligned_allocator<std::uint64_t, 64>>;
struct alignas(64) Column {
  std::array<double, k_block_points> values;
};

/// Few different magnitudes, so that there are ties; zeros of both signs, tiny and huge ones.
std::vector<Column> distances_with_ties(std::size_t primitives, RandomStream& random) {
  constexpr std::array<double, 8> k_special{0.0, -0.0, 1e-320, -1e-320, 0.5, -0.5, 1e300, -1e300};
  std::vector<Column> columns(primitives);
  for (Column& column : columns) {
    for (double& value : column.values) {
      value = random.chance(0.5) ? k_special[random.below(k_special.size())] : random.uniform(-1, 1);
    }
  }
  return columns;
}

std::vector<const double*> pointers_to(const std::vector<Column>& columns) {
  std::vector<const double*> pointers;
  for (const Column& column : columns) pointers.push_back(column.values.data());
  return pointers;
}

Keys keys_by_sorting(const std::vector<Column>& columns, const KeyLayout& layout) {
  Keys keys(layout.words * k_block_points);
  sort_rank_keys(pointers_to(columns), layout, keys.data());
  return keys;
}

Keys keys_by_comparing(const std::vector<Column>& columns, const KeyLayout& layout) {
  Keys keys(layout.words * k_block_points, 0xdead);
  compute_rank_keys(pointers_to(columns), layout, keys.data());
  return keys;
}

int rank_at(const Keys& keys, const KeyLayout& layout, std::size_t primitives, std::size_t p, std::size_t point) {
  const std::uint64_t word = keys[layout.word_of(p) * k_block_points + point];
  const std::uint64_t code = word >> layout.shift_of(p) & ((std::uint64_t{1} << layout.bits) - 1);
  return static_cast<int>(code) - static_cast<int>(primitives);
}

RC_GTEST_PROP(RankKeys, ComparingAndSortingGiveTheSameBitsOnEveryInstructionSet, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(random.chance(0.1) ? 140 : 24);
  const std::vector<Column> columns = distances_with_ties(primitives, random);
  const KeyLayout layout(primitives);
  const Keys expected = keys_by_sorting(columns, layout);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    if (keys_by_comparing(columns, layout) != expected) RC_FAIL(std::string(hwy::TargetName(target)));
  }
}

/// Straight from the definition: one more than how many are smaller, or equal and of smaller index.
RC_GTEST_PROP(RankKeys, AreTheSignedRanksOfTheDefinition, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(random.chance(0.1) ? 200 : 12);
  const std::vector<Column> columns = distances_with_ties(primitives, random);
  const KeyLayout layout(primitives);
  const Keys keys = keys_by_sorting(columns, layout);
  for (const std::size_t point : {std::size_t{0}, std::size_t{17}, k_block_points - 1}) {
    for (std::size_t p = 0; p < primitives; ++p) {
      const double value = columns[p].values[point];
      int rank = 1;
      for (std::size_t q = 0; q < primitives; ++q) {
        const double other = std::abs(columns[q].values[point]);
        rank += other < std::abs(value) || (other == std::abs(value) && q < p) ? 1 : 0;
      }
      RC_ASSERT(rank_at(keys, layout, primitives, p, point) == (value < 0 ? -rank : rank));
    }
  }
}

TEST(KeyLayout, HasRoomForEveryRank) {
  for (std::size_t primitives = 1; primitives <= 300; ++primitives) {
    const KeyLayout layout(primitives);
    EXPECT_GE(std::uint64_t{1} << layout.bits, 2 * primitives + 1) << primitives;
    EXPECT_LT(layout.word_of(primitives - 1), layout.words) << primitives;
    for (std::size_t p = 0; p < primitives; ++p) EXPECT_LE(layout.shift_of(p) + layout.bits, 64U) << primitives;
  }
}

/// A field, normals and the true angle between them.
struct Block {
  BlockField field;
  BlockNormals normals;
  std::array<double, k_block_points> angles;
};

double log_uniform(double low, double high, RandomStream& random) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

Block random_block(bool unit_gradient, RandomStream& random) {
  Block block;
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const double sign = random.chance(0.5) ? 1 : -1;
    block.field.distance[i] = random.chance(0.1) ? 0.0 : sign * log_uniform(1e-9, 1e6, random);
    constexpr std::array<double, 5> k_angles{0, std::numbers::pi / 4, std::numbers::pi / 2, 3, std::numbers::pi};
    block.angles[i] =
        random.chance(0.2) ? k_angles[random.below(k_angles.size())] : random.uniform(0, std::numbers::pi);
    const Eigen::Vector3d normal = test::random_direction(random);
    const Eigen::Vector3d across = normal.unitOrthogonal();
    const double length = unit_gradient ? 1.0 : log_uniform(1e-6, 1e6, random);
    const Eigen::Vector3d slope = length * (std::cos(block.angles[i]) * normal + std::sin(block.angles[i]) * across);
    block.normals.x[i] = normal.x(), block.normals.y[i] = normal.y(), block.normals.z[i] = normal.z();
    block.field.gradient_x[i] = slope.x(), block.field.gradient_y[i] = slope.y(), block.field.gradient_z[i] = slope.z();
  }
  return block;
}

ContributionParameters random_parameters(bool unit_gradient, RandomStream& random) {
  return {.beta = log_uniform(1e-3, 1e4, random),
          .gamma = random.chance(0.5) ? 18 / std::numbers::pi : log_uniform(0.05, 100, random),
          .tolerances = {.distance = 0.1, .cosine = std::cos(0.5)},
          .unit_gradient = unit_gradient};
}

RC_GTEST_PROP(Contributions, AreThePointScoresTo2ToTheMinus21OnEveryInstructionSet, (std::uint64_t seed)) {
  RandomStream random(seed);
  const bool unit_gradient = random.chance(0.5);
  const Block block = random_block(unit_gradient, random);
  const ContributionParameters parameters = random_parameters(unit_gradient, random);
  const Objective objective{.alpha = 0, .beta = parameters.beta, .gamma = parameters.gamma};
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockContributions out;
    compute_contributions(block.field, block.normals, parameters, out);
    for (std::size_t i = 0; i < k_block_points; ++i) {
      const double plain = point_score(block.field.distance[i], block.angles[i], objective);
      const double turned = point_score(block.field.distance[i], std::numbers::pi - block.angles[i], objective);
      RC_ASSERT(std::abs(static_cast<double>(out.pairs[2 * i]) - plain) <= 0x1p-21);
      RC_ASSERT(std::abs(static_cast<double>(out.pairs[2 * i + 1]) - turned) <= 0x1p-21);
    }
  }
}

RC_GTEST_PROP(Contributions, AreTheSameBitsOnEveryInstructionSet, (std::uint64_t seed)) {
  RandomStream random(seed);
  const bool unit_gradient = random.chance(0.5);
  const Block block = random_block(unit_gradient, random);
  const ContributionParameters parameters = random_parameters(unit_gradient, random);
  BlockContributions expected;
  compute_contributions(block.field, block.normals, parameters, expected);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockContributions out;
    compute_contributions(block.field, block.normals, parameters, out);
    RC_ASSERT(out.pairs == expected.pairs);
    RC_ASSERT(out.member == expected.member);
  }
}

RC_GTEST_PROP(Contributions, AreMultiplesOf2ToTheMinus22SoThatSumsAreExact, (std::uint64_t seed)) {
  RandomStream random(seed);
  BlockContributions out;
  compute_contributions(random_block(true, random).field, random_block(true, random).normals,
                        random_parameters(true, random), out);
  for (const float score : out.pairs) {
    const double units = std::ldexp(static_cast<double>(score), 22);
    RC_ASSERT(units == std::round(units));
    RC_ASSERT(units >= 0 && units <= std::ldexp(2.0, 22));
  }
}

TEST(Contributions, AMemberIsNearAndFacesOneOfTheTwoWays) {
  RandomStream random(3);
  Block block = random_block(true, random);
  const auto put = [&block](std::size_t i, double distance, double angle) {
    block.field.distance[i] = distance;
    block.normals.x[i] = 0, block.normals.y[i] = 0, block.normals.z[i] = 1;
    block.field.gradient_x[i] = std::sin(angle), block.field.gradient_y[i] = 0;
    block.field.gradient_z[i] = std::cos(angle);
  };
  put(0, 0.09, 0.4);
  put(1, -0.09, 0.4);
  put(63, 0.09, std::numbers::pi - 0.4);
  put(64, 0.11, 0.4);
  put(255, 0.09, 0.6);
  put(2, 0.09, std::numbers::pi - 0.6);
  const ContributionParameters parameters{
      .beta = 1, .gamma = 1, .tolerances = {.distance = 0.1, .cosine = std::cos(0.5)}, .unit_gradient = true};
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockContributions out;
    compute_contributions(block.field, block.normals, parameters, out);
    const auto is_member = [&out](std::size_t i) { return (out.member[i / 64] >> (i % 64) & 1U) != 0; };
    EXPECT_TRUE(is_member(0) && is_member(1) && is_member(63)) << hwy::TargetName(target);
    EXPECT_FALSE(is_member(64) || is_member(255) || is_member(2)) << hwy::TargetName(target);
  }
}

}  // namespace
}  // namespace cloud2csg
