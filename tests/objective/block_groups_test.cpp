#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <map>
#include <numeric>
#include <vector>

#include "core/base/random.hpp"
#include "paper/objective/class_table.hpp"

namespace cloud2csg {
namespace {

/// Keys of two words, of so many different ones; hashes may be alike, and be anything.
BlockKeys random_keys(std::size_t different, std::size_t hashes, RandomStream& random) {
  BlockKeys keys(2);
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const std::uint32_t key = random.below(different);
    keys.words[i] = key % 7;
    keys.words[k_block_points + i] = key / 7;
    keys.hashes[i] = static_cast<std::uint32_t>(key % hashes * 0x9e37'79b1U);
  }
  return keys;
}

RC_GTEST_PROP(BlockGroups, AreThePointsOfEqualKeys, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t different = 1 + random.below(random.chance(0.5) ? 10 : 5000);
  const BlockKeys keys = random_keys(different, 1 + random.below(different), random);
  std::vector<std::uint16_t> points;
  for (std::uint16_t i = 0; i < k_block_points; ++i) {
    if (random.chance(0.8)) points.push_back(i);
  }
  BlockGroups groups;
  groups.group(random_keys(50, 50, random), points);  // what was there before is gone
  groups.group(keys, points);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> expected;
  for (std::size_t k = 0; k < points.size(); ++k) {
    expected[{keys.words[points[k]], keys.words[k_block_points + points[k]]}].push_back(k);
  }
  RC_ASSERT(groups.size() == expected.size());
  for (const auto& [key, members] : expected) {
    const std::size_t group = groups.group_of(members.front());
    RC_ASSERT(groups.first_points()[group] == points[members.front()]);
    RC_ASSERT(groups.count(group) == members.size());
    for (const std::size_t k : members) RC_ASSERT(groups.group_of(k) == group);
  }
}

TEST(BlockGroups, AreAsManyAsPointsWhenAllKeysDiffer) {
  BlockKeys keys(1);
  std::vector<std::uint16_t> points(k_block_points);
  std::iota(points.begin(), points.end(), std::uint16_t{0});
  std::iota(keys.words.begin(), keys.words.end(), 0U);
  keys.hashes.fill(511);  // all begin at the last slot
  BlockGroups groups;
  groups.group(keys, points);
  EXPECT_EQ(groups.size(), k_block_points);
  groups.group(keys, {});
  EXPECT_EQ(groups.size(), 0U);
}

}  // namespace
}  // namespace cloud2csg
