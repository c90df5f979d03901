#include "raw/solids/regular_places.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.hpp"
#include "support/properties.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Places = std::vector<Vector2d>;

constexpr double k_reach = 0.01;

RegularPlaces arranged(const Places& places, const Places& centres = {}) {
  return regular_places(places, std::vector<int>(places.size(), 0), std::vector<double>(places.size(), 1.0), centres,
                        k_reach);
}

/// Moved by half the tolerance at most, and in any order.
Places disturbed(Places places, RandomStream& random) {
  for (Vector2d& place : places) {
    place.x() += random.uniform(-0.35, 0.35) * k_reach;
    place.y() += random.uniform(-0.35, 0.35) * k_reach;
  }
  for (std::size_t i = places.size(); i > 1; --i) std::swap(places[i - 1], places[random.below(i)]);
  return places;
}

Places grid(const Vector2d& origin, const Vector2d& first, const Vector2d& second, int columns, int rows) {
  Places places;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) places.push_back(origin + i * first + j * second);
  }
  return places;
}

Places circle(const Vector2d& centre, double radius, double start, std::size_t count) {
  Places places;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = start + 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
    places.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return places;
}

void expect_all(const RegularPlaces& regular, const Places& given, Arrangement arrangement) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(regular.arrangements[i], arrangement) << i;
    EXPECT_LE((regular.places[i] - given[i]).norm(), k_reach) << i;
  }
}

/// The differences that there are, but for rounding and sign.
std::size_t count_different(std::vector<double> numbers) {
  std::ranges::sort(numbers);
  const auto same = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  return static_cast<std::size_t>(std::unique(numbers.begin(), numbers.end(), same) - numbers.begin());
}

RC_GTEST_PROP(RegularPlaces, GridsAlongTheAxesGetAsManyCoordinatesAsTheyHaveRowsAndColumns, (std::uint64_t seed)) {
  RandomStream random(seed);
  const int columns = 2 + static_cast<int>(random.below(6));
  const int rows = 2 + static_cast<int>(random.below(6));
  const Vector2d first(random.uniform(0.2, 1), 0);
  const Vector2d second(0, random.uniform(0.2, 1));
  const Places given =
      disturbed(grid({random.uniform(-5, 5), random.uniform(-5, 5)}, first, second, columns, rows), random);
  const RegularPlaces regular = arranged(given);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < given.size(); ++i) {
    RC_ASSERT(regular.arrangements[i] != Arrangement::none);
    RC_ASSERT((regular.places[i] - given[i]).norm() <= k_reach);
    x.push_back(regular.places[i].x());
    y.push_back(regular.places[i].y());
  }
  RC_ASSERT(count_different(x) == static_cast<std::size_t>(columns));
  RC_ASSERT(count_different(y) == static_cast<std::size_t>(rows));
}

RC_GTEST_PROP(RegularPlaces, AnyGridHasEqualSteps, (std::uint64_t seed)) {
  RandomStream random(seed);
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const double angle = random.uniform(1.1, 1.9);
  const Vector2d first = random.uniform(0.3, 1) * Vector2d(std::cos(turn), std::sin(turn));
  const Vector2d second = random.uniform(0.3, 1) * Vector2d(std::cos(turn + angle), std::sin(turn + angle));
  const Places given = disturbed(grid({1, 2}, first, second, 4, 3), random);
  const RegularPlaces regular = arranged(given);
  expect_all(regular, given, Arrangement::grid);
  // Twelve places on a grid have 17 differences between them, or 19 with a basis that is not the shortest.
  std::vector<double> differences;
  const Vector2d any(0.731, 0.412);
  for (const Vector2d& a : regular.places) {
    for (const Vector2d& b : regular.places) differences.push_back(std::abs(any.dot(a - b)));
  }
  EXPECT_LE(count_different(differences), 18U);
  test::fail_property_when_failed();
}

RC_GTEST_PROP(RegularPlaces, CirclesHaveEqualAnglesAboutWhatIsAtTheirCentre, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t count = 3 + random.below(12);
  const Vector2d centre(random.uniform(-3, 3), random.uniform(-3, 3));
  const double radius = random.uniform(0.8, 3);
  Places given = disturbed(circle(centre, radius, random.uniform(-4, 4), count), random);
  const RegularPlaces regular = arranged(given, {Vector2d(7, 7), centre});
  expect_all(regular, given, Arrangement::circle);
  std::vector<double> distances, chords;
  for (const Vector2d& a : regular.places) {
    distances.push_back((a - centre).norm());
    for (const Vector2d& b : regular.places) chords.push_back((a - b).norm());
  }
  EXPECT_EQ(count_different(distances), 1U);
  EXPECT_EQ(count_different(chords), count / 2 + 1);
  test::fail_property_when_failed();
}

/// Without anything at their centre, and laid along the axes.
TEST(RegularPlaces, CirclesHaveCentresOfTheirOwn) {
  RandomStream random(5);
  const Places given = disturbed(circle({1, 1}, 2, 0, 5), random);
  const RegularPlaces regular = arranged(given);
  expect_all(regular, given, Arrangement::circle);
  const auto right = std::ranges::max_element(regular.places, {}, [](const Vector2d& p) { return p.x(); });
  EXPECT_NEAR(right->y(), 1, 0.5 * k_reach);
}

TEST(RegularPlaces, RowsAreStraightWithEqualSteps) {
  RandomStream random(1);
  Places given = grid({0, 0}, {0.7, 0.2}, {0, 0}, 5, 1);
  given = disturbed(given, random);
  given.emplace_back(9, 9);
  const RegularPlaces regular = arranged(given);
  EXPECT_EQ(regular.arrangements.back(), Arrangement::none);
  EXPECT_EQ(regular.places.back(), given.back());
  Places row(regular.places.begin(), regular.places.end() - 1);
  std::ranges::sort(row, {}, [](const Vector2d& p) { return p.x(); });
  for (std::size_t k = 2; k < row.size(); ++k) {
    EXPECT_LT((row[k] - 2 * row[k - 1] + row[k - 2]).norm(), 1e-12);
  }
}

/// Three times three about a place in the middle: a grid, not two circles and a place.
TEST(RegularPlaces, TakesWhatHasMorePlaces) {
  RandomStream random(2);
  const Places given = disturbed(grid({0, 0}, {1, 0}, {0, 1}, 3, 3), random);
  expect_all(arranged(given, given), given, Arrangement::grid);
}

TEST(RegularPlaces, DifferentKindsAreNotOfOneArrangement) {
  const Places given = grid({0, 0}, {1, 0}, {0, 0}, 4, 1);
  const std::vector<double> weights(4, 1.0);
  const RegularPlaces regular = regular_places(given, std::vector<int>{0, 1, 0, 1}, weights, {}, k_reach);
  EXPECT_EQ(regular.arrangements, std::vector<Arrangement>(4, Arrangement::none));
}

TEST(RegularPlaces, LeavesAloneWhatIsNotRegular) {
  RandomStream random(4);
  for (int attempt = 0; attempt < 300; ++attempt) {
    Places given;
    for (int i = 0; i < 6; ++i) given.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20));
    const RegularPlaces regular = arranged(given, given);
    expect_all(regular, given, Arrangement::none);
    EXPECT_EQ(regular.places, given);
  }
}

TEST(RegularPlaces, OfNoneOrOneAreNothing) {
  EXPECT_TRUE(arranged({}).places.empty());
  EXPECT_EQ(arranged({Vector2d(1, 2)}).places[0], Vector2d(1, 2));
  EXPECT_EQ(arranged({Vector2d(1, 2), Vector2d(1, 2), Vector2d(1, 2)}).arrangements[0], Arrangement::none);
}

}  // namespace
}  // namespace cloud2csg
