#include "core/geometry/subset.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

namespace cloud2csg {
namespace {

std::vector<int> numbers(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

RC_GTEST_PROP(Subset, SomeAreEvenlyAlongTheList, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 500);
  const auto most = *rc::gen::inRange<std::size_t>(1, 500);
  const std::vector<int> some = some_of(numbers(count), most);
  RC_ASSERT(some.size() == std::min(count, most));
  if (count <= most) RC_ASSERT(some == numbers(count));
  if (!some.empty()) RC_ASSERT(some.front() == 0);
  const int step = count > most ? static_cast<int>(count / most) : 1;
  for (std::size_t k = 1; k < some.size(); ++k) {
    RC_ASSERT(some[k] - some[k - 1] >= step);
    RC_ASSERT(some[k] - some[k - 1] <= step + 1);
  }
}

RC_GTEST_PROP(Subset, OneOfEveryFewIsOneOfEach, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(0, 500);
  const auto most = *rc::gen::inRange<std::size_t>(1, 500);
  const std::vector<std::uint32_t> some = one_of_every_few(count, most, RandomStream(*rc::gen::arbitrary<unsigned>()));
  RC_ASSERT(some.size() <= most);
  const std::size_t few = count <= most ? 1 : (count + most - 1) / most;
  RC_ASSERT(some.size() == (count + few - 1) / few);
  for (std::size_t k = 0; k < some.size(); ++k) {
    RC_ASSERT(some[k] / few == k);
    RC_ASSERT(some[k] < count);
  }
}

TEST(Subset, ChanceTellsWhichOfEveryFew) {
  EXPECT_EQ(one_of_every_few(1000, 10, RandomStream(1)), one_of_every_few(1000, 10, RandomStream(1)));
  EXPECT_NE(one_of_every_few(1000, 10, RandomStream(1)), one_of_every_few(1000, 10, RandomStream(2)));
}

}  // namespace
}  // namespace cloud2csg
