#include "core/base/random.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <set>

namespace cloud2csg {
namespace {

RC_GTEST_PROP(RandomStream, SameKeyGivesSameStream,
              (std::uint64_t seed, std::uint64_t stage, std::uint64_t item, std::uint64_t step)) {
  RandomStream a(seed, stage, item, step);
  RandomStream b(seed, stage, item, step);
  for (int i = 0; i < 10; ++i) RC_ASSERT(a.next() == b.next());
}

TEST(RandomStream, EveryPartOfTheKeyCounts) {
  std::set<std::uint64_t> first_words;
  std::size_t streams = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (std::uint64_t stage = 0; stage < 6; ++stage) {
      for (std::uint64_t item = 0; item < 6; ++item) {
        for (std::uint64_t step = 0; step < 6; ++step) {
          first_words.insert(RandomStream(seed, stage, item, step).next());
          ++streams;
        }
      }
    }
  }
  EXPECT_EQ(first_words.size(), streams);
}

RC_GTEST_PROP(RandomStream, UniformStaysInItsRange, (std::uint64_t seed)) {
  RandomStream random(seed);
  for (int i = 0; i < 100; ++i) {
    const double value = random.uniform(-2.0, 3.0);
    RC_ASSERT(value >= -2.0);
    RC_ASSERT(value < 3.0);
  }
}

RC_GTEST_PROP(RandomStream, BelowStaysInItsRange, (std::uint64_t seed)) {
  RandomStream random(seed);
  const auto count = *rc::gen::inRange<std::size_t>(1, 4'000'000'000);
  for (int i = 0; i < 100; ++i) RC_ASSERT(random.below(count) < count);
  RC_ASSERT(random.below(1) == 0U);
}

TEST(RandomStream, BelowIsUniform) {
  constexpr int k_draws = 70'000;
  std::array<int, 7> hits{};
  RandomStream random(11);
  for (int i = 0; i < k_draws; ++i) ++hits[random.below(hits.size())];
  for (const int count : hits) EXPECT_NEAR(count, k_draws / 7.0, 5 * std::sqrt(k_draws / 7.0));
}

TEST(RandomStream, ChanceHasItsProbability) {
  constexpr int k_draws = 40'000;
  int hits = 0;
  RandomStream random(5);
  for (int i = 0; i < k_draws; ++i) hits += random.chance(0.3) ? 1 : 0;
  EXPECT_NEAR(hits, 0.3 * k_draws, 5 * std::sqrt(0.21 * k_draws));
}

TEST(RandomStream, NormalHasTheMomentsOfTheStandardNormal) {
  constexpr int k_draws = 200'000;
  RandomStream random(3);
  double sum = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0;
  for (int i = 0; i < k_draws; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    cubes += value * value * value;
    fourths += value * value * value * value;
  }
  EXPECT_NEAR(sum / k_draws, 0.0, 0.012);
  EXPECT_NEAR(squares / k_draws, 1.0, 0.016);
  EXPECT_NEAR(cubes / k_draws, 0.0, 0.045);
  EXPECT_NEAR(fourths / k_draws, 3.0, 0.11);
}

}  // namespace
}  // namespace cloud2csg
