#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "paper/objective/rank_kernels.hpp"
#include "support/field_block.hpp"
#include "support/forced_target.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using test::Column;

/// Few different magnitudes, so that there are ties; zeros of both signs, tiny and huge ones.
template <class Real>
std::vector<Column<Real>> distances_with_ties(std::size_t primitives, RandomStream& random) {
  constexpr Real k_tiny = std::numeric_limits<Real>::denorm_min();
  constexpr Real k_huge = std::numeric_limits<Real>::max();
  constexpr std::array<Real, 8> k_special{0, -Real{0}, k_tiny, -k_tiny, Real(0.5), -Real(0.5), k_huge, -k_huge};
  std::vector<Column<Real>> columns(primitives);
  for (Column<Real>& column : columns) {
    // Some primitives are nearer than others at all points, some at some.
    const Real scale = random.chance(0.5) ? Real(1) : static_cast<Real>(random.uniform(0, 3));
    const bool is_special = random.chance(0.7);
    for (Real& value : column.values) {
      value = is_special && random.chance(0.5) ? k_special[random.below(k_special.size())]
                                               : scale + static_cast<Real>(random.uniform(-1, 1));
    }
  }
  return columns;
}

template <class Real>
std::vector<DistanceColumn<Real>> bounded(const std::vector<Column<Real>>& columns) {
  std::vector<DistanceColumn<Real>> result;
  for (const Column<Real>& column : columns) {
    std::array<Real, k_block_points> magnitudes = column.values;
    for (Real& value : magnitudes) value = std::abs(value);
    const auto [least, most] = std::ranges::minmax(magnitudes);
    result.push_back({column.values.data(), least, most});
  }
  return result;
}

template <class Real>
AlignedVector<std::uint32_t> keys_by_sorting(const std::vector<Column<Real>>& columns, const KeyLayout& layout) {
  std::vector<const Real*> pointers;
  pointers.reserve(columns.size());
  for (const Column<Real>& column : columns) pointers.push_back(column.values.data());
  BlockKeys keys(layout.words);
  sort_rank_keys(pointers, layout, keys);
  return keys.words;
}

template <class Real>
AlignedVector<std::uint32_t> keys_by_comparing(const std::vector<Column<Real>>& columns, const KeyLayout& layout) {
  std::vector<RankColumn> ranks(columns.size());
  compute_signed_ranks(bounded(columns), ranks);
  BlockKeys keys(layout.words);
  pack_rank_keys(ranks, layout, keys);
  return keys.words;
}

int rank_at(std::span<const std::uint32_t> keys, const KeyLayout& layout, std::size_t primitives, std::size_t p,
            std::size_t point) {
  const std::uint32_t word = keys[layout.word_of(p) * k_block_points + point];
  const std::uint32_t code = word >> layout.shift_of(p) & ((std::uint32_t{1} << layout.bits) - 1);
  return static_cast<int>(code) - static_cast<int>(primitives);
}

template <class Real>
void expect_same_keys(std::uint64_t seed) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(random.chance(0.1) ? 127 : 24);
  const std::vector<Column<Real>> columns = distances_with_ties<Real>(primitives, random);
  const KeyLayout layout(primitives);
  const AlignedVector<std::uint32_t> expected = keys_by_sorting(columns, layout);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    if (keys_by_comparing(columns, layout) != expected) RC_FAIL(std::string(hwy::TargetName(target)));
  }
}

RC_GTEST_PROP(RankKeys, ComparingAndSortingGiveTheSameBitsOnEveryInstructionSet, (std::uint64_t seed)) {
  expect_same_keys<double>(seed);
  expect_same_keys<float>(seed);
}

/// Straight from the definition: one more than how many are smaller, or equal and of smaller index.
RC_GTEST_PROP(RankKeys, AreTheSignedRanksOfTheDefinition, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(random.chance(0.1) ? 200 : 12);
  const std::vector<Column<double>> columns = distances_with_ties<double>(primitives, random);
  const KeyLayout layout(primitives);
  const AlignedVector<std::uint32_t> keys = keys_by_sorting(columns, layout);
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

/// The order of some primitives follows from the order of all.
RC_GTEST_PROP(SignedRanks, AmongFewerAreThoseOfTheFewer, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::vector<Column<double>> columns = distances_with_ties<double>(1 + random.below(24), random);
  std::vector<RankColumn> ranks(columns.size());
  compute_signed_ranks(bounded(columns), ranks);
  std::vector<Column<double>> fewer;
  std::vector<const RankColumn*> ranks_of_fewer;
  for (std::size_t p = 0; p < columns.size(); ++p) {
    if (random.chance(0.5)) continue;
    fewer.push_back(columns[p]);
    ranks_of_fewer.push_back(&ranks[p]);
  }
  std::vector<RankColumn> expected(fewer.size());
  compute_signed_ranks(bounded(fewer), expected);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    std::vector<RankColumn> found(fewer.size());
    compute_signed_ranks(ranks_of_fewer, found);
    for (std::size_t p = 0; p < fewer.size(); ++p) RC_ASSERT(found[p].ranks == expected[p].ranks);
  }
}

RC_GTEST_PROP(BlockKeys, MembersAndHashesAreTheSameOnEveryInstructionSet, (std::uint64_t seed)) {
  RandomStream random(seed);
  std::vector<BlockMask> masks(1 + random.below(32));
  std::vector<const BlockMask*> pointers;
  for (BlockMask& mask : masks) {
    for (std::uint64_t& word : mask) word = random.next() & random.next();
    pointers.push_back(&mask);
  }
  std::array<std::uint32_t, k_block_points> first_hashes{};
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockKeys keys(2);
    std::ranges::fill(keys.words, 7U);
    pack_member_word(pointers, keys);
    compute_hashes(keys);
    for (std::size_t i = 0; i < k_block_points; ++i) {
      RC_ASSERT(keys.words[i] == 7U);
      for (std::size_t k = 0; k < masks.size(); ++k) {
        RC_ASSERT((keys.words[k_block_points + i] >> k & 1U) == (has_point(masks[k], i) ? 1U : 0U));
      }
    }
    if (target == test::all_targets().front()) first_hashes = keys.hashes;
    RC_ASSERT(keys.hashes == first_hashes);
  }
}

TEST(KeyLayout, HasRoomForEveryRank) {
  for (std::size_t primitives = 1; primitives <= 300; ++primitives) {
    const KeyLayout layout(primitives);
    EXPECT_GE(std::uint32_t{1} << layout.bits, 2 * primitives + 1) << primitives;
    EXPECT_LT(layout.word_of(primitives - 1), layout.words) << primitives;
    for (std::size_t p = 0; p < primitives; ++p) EXPECT_LE(layout.shift_of(p) + layout.bits, 32U) << primitives;
  }
}

/// A field, normals and the true angle between them.
template <class Real>
struct Block : test::FieldBlock<Real> {
  std::array<double, k_block_points> angles;
};

double log_uniform(double low, double high, RandomStream& random) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

template <class Real>
Block<Real> random_block(bool unit_gradient, RandomStream& random) {
  Block<Real> block;
  const bool is_far = random.chance(0.3);  // silent in most places
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const double sign = random.chance(0.5) ? 1 : -1;
    const double distance = is_far ? log_uniform(1e2, 1e6, random) : log_uniform(1e-9, 1e6, random);
    block.field.distance[i] = static_cast<Real>(random.chance(is_far ? 0.001 : 0.1) ? 0.0 : sign * distance);
    constexpr std::array<double, 5> k_angles{0, std::numbers::pi / 4, std::numbers::pi / 2, 3, std::numbers::pi};
    block.angles[i] =
        random.chance(0.2) ? k_angles[random.below(k_angles.size())] : random.uniform(0, std::numbers::pi);
    const Eigen::Vector3d normal = test::random_direction(random);
    const Eigen::Vector3d across = normal.unitOrthogonal();
    const double length = unit_gradient ? 1.0 : log_uniform(1e-6, 1e6, random);
    block.set_normal(i, normal);
    block.set_gradient(i, length * (std::cos(block.angles[i]) * normal + std::sin(block.angles[i]) * across));
  }
  return block;
}

ContributionParameters random_parameters(bool unit_gradient, RandomStream& random) {
  return {.beta = log_uniform(1e-3, 1e4, random),
          .gamma = random.chance(0.5) ? 18 / std::numbers::pi : log_uniform(0.05, 100, random),
          .tolerances = {.distance = 0.1, .cosine = std::cos(0.5)},
          .unit_gradient = unit_gradient};
}

/// A score from the numbers that the kernel is given, in double precision.
template <class Real>
double score_of(const Block<Real>& block, std::size_t i, double side, const Objective& objective) {
  const Eigen::Vector3d slope(static_cast<double>(block.field.gradient_x[i]),
                              static_cast<double>(block.field.gradient_y[i]),
                              static_cast<double>(block.field.gradient_z[i]));
  Eigen::Vector3d normal;
  for (int axis = 0; axis < 3; ++axis) {
    normal[axis] = static_cast<double>(block.normal_columns[static_cast<std::size_t>(axis)].values[i]);
  }
  const double sine = side * slope.normalized().cross(normal.normalized()).norm();
  const double angle = std::atan2(std::abs(sine), side * slope.normalized().dot(normal.normalized()));
  return point_score(static_cast<double>(block.field.distance[i]), angle, objective);
}

/// `least_gamma`: what the kernel is used for in this precision.
template <class Real>
void expect_point_scores(std::uint64_t seed, double tolerance, double least_gamma) {
  RandomStream random(seed);
  const bool unit_gradient = random.chance(0.5);
  const Block<Real> block = random_block<Real>(unit_gradient, random);
  ContributionParameters parameters = random_parameters(unit_gradient, random);
  parameters.gamma = std::max(parameters.gamma, least_gamma);
  const Objective objective{.alpha = 0, .beta = parameters.beta, .gamma = parameters.gamma};
  // What a rounding of the cosine moves the square of the angle by is multiplied by gamma's.
  const double allowed = 0x1p-21 + tolerance * (1 + parameters.gamma * parameters.gamma);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockContributions<Real> out;
    compute_contributions(block.field, block.normals(), parameters, out);
    bool is_silent = true;
    for (std::size_t i = 0; i < k_block_points; ++i) {
      RC_ASSERT(std::abs(k_unit * static_cast<double>(out.units.plain[i]) - score_of(block, i, 1, objective)) <=
                allowed);
      RC_ASSERT(std::abs(k_unit * static_cast<double>(out.units.complement[i]) - score_of(block, i, -1, objective)) <=
                allowed);
      is_silent = is_silent && out.units.plain[i] == 0 && out.units.complement[i] == 0;
      RC_ASSERT(std::abs(block.field.distance[i]) >= out.smallest && std::abs(block.field.distance[i]) <= out.largest);
    }
    RC_ASSERT(out.is_silent == is_silent);
  }
}

RC_GTEST_PROP(Contributions, AreThePointScoresTo2ToTheMinus21OnEveryInstructionSet, (std::uint64_t seed)) {
  expect_point_scores<double>(seed, 0, 0);
  expect_point_scores<float>(seed, 1e-6, 3);
}

template <class Real>
void expect_same_bits(std::uint64_t seed) {
  RandomStream random(seed);
  const bool unit_gradient = random.chance(0.5);
  const Block<Real> block = random_block<Real>(unit_gradient, random);
  const ContributionParameters parameters = random_parameters(unit_gradient, random);
  BlockContributions<Real> expected;
  compute_contributions(block.field, block.normals(), parameters, expected);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockContributions<Real> out;
    compute_contributions(block.field, block.normals(), parameters, out);
    RC_ASSERT(out.units.plain == expected.units.plain && out.units.complement == expected.units.complement);
    RC_ASSERT(out.member == expected.member);
    RC_ASSERT(out.smallest == expected.smallest && out.largest == expected.largest);
  }
}

RC_GTEST_PROP(Contributions, AreTheSameBitsOnEveryInstructionSet, (std::uint64_t seed)) {
  expect_same_bits<double>(seed);
  expect_same_bits<float>(seed);
}

RC_GTEST_PROP(Contributions, OfManyPointsFitTheHalvesOfASum, (std::uint64_t seed)) {
  RandomStream random(seed);
  BlockContributions<double> out;
  const Block<double> block = random_block<double>(true, random);
  compute_contributions(block.field, block.normals(), random_parameters(true, random), out);
  constexpr std::uint64_t k_largest_sum = 0xffff'ffff;
  for (std::size_t i = 0; i < k_block_points; ++i) {
    RC_ASSERT(std::uint64_t{out.units.plain[i]} * k_most_packed_points <= k_largest_sum);
    RC_ASSERT(std::uint64_t{out.units.complement[i]} * k_most_packed_points <= k_largest_sum);
  }
}

RC_GTEST_PROP(Contributions, OfTwoPrimitivesInterleaveOnEveryInstructionSet, (std::uint64_t seed)) {
  RandomStream random(seed);
  std::array<BlockUnits, 2> of;
  for (BlockUnits& units : of) {
    for (std::uint32_t& unit : units.plain) unit = random.below(1U << 24U);
    for (std::uint32_t& unit : units.complement) unit = random.below(1U << 24U);
  }
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    PackedPairs pairs;
    interleave(of[0], of[1], pairs);
    for (std::size_t i = 0; i < k_block_points; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        RC_ASSERT(plain_units(pairs.of[i][k]) == of[k].plain[i]);
        RC_ASSERT(complement_units(pairs.of[i][k]) == of[k].complement[i]);
      }
    }
  }
}

TEST(Contributions, AMemberIsNearAndFacesOneOfTheTwoWays) {
  RandomStream random(3);
  Block<double> block = random_block<double>(true, random);
  const auto put = [&block](std::size_t i, double distance, double angle) {
    block.field.distance[i] = distance;
    block.set_normal(i, Eigen::Vector3d::UnitZ());
    block.set_gradient(i, {std::sin(angle), 0, std::cos(angle)});
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
    BlockContributions<double> out;
    compute_contributions(block.field, block.normals(), parameters, out);
    const auto is_member = [&out](std::size_t i) { return has_point(out.member, i); };
    EXPECT_TRUE(is_member(0) && is_member(1) && is_member(63)) << hwy::TargetName(target);
    EXPECT_FALSE(is_member(64) || is_member(255) || is_member(2)) << hwy::TargetName(target);
  }
}

}  // namespace
}  // namespace cloud2csg
