#include "raw/solids/curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// With points from one place to the other.
Curve line(const Vector2d& from, const Vector2d& to) {
  Curve curve{.normal = -to_the_left((to - from).normalized())};
  curve.offset = curve.normal.dot(from);
  for (int k = 0; k <= 20; ++k) curve.points.emplace_back(from + k / 20.0 * (to - from));
  curve.count = curve.points.size();
  return curve;
}

/// With points between two angles, in degrees.
Curve arc(const Vector2d& centre, double radius, double from, double to) {
  Curve curve{.is_circle = true, .normal = centre, .offset = radius};
  for (int k = 0; k <= 40; ++k) {
    const double angle = (from + k / 40.0 * (to - from)) * std::numbers::pi / 180;
    curve.points.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  curve.count = curve.points.size();
  return curve;
}

/// Whether the part of the curve contains the place.
bool reaches(const std::vector<Curve>& curves, std::size_t c, const Vector2d& place, double reach = 0.05) {
  const std::vector<ProfileSegment> pieces = pieces_of(curves[c], extents_of(curves, reach)[c]);
  return std::ranges::any_of(pieces,
                             [&](const ProfileSegment& s) { return (nearest(s, place) - place).norm() < 1e-9; });
}

TEST(ExtentsOf, ReachALittleBeyondThePoints) {
  const std::vector<Curve> alone{line({0, 0}, {1, 0})};
  EXPECT_TRUE(reaches(alone, 0, {1.05, 0}));
  EXPECT_FALSE(reaches(alone, 0, {1.06, 0}));
  EXPECT_TRUE(reaches(alone, 0, {-0.05, 0}));
}

TEST(ExtentsOf, GoOnToACornerThatIsHidden) {
  const std::vector<Curve> angle{line({0, 0}, {0.7, 0}), line({1, 0.4}, {1, 1})};
  EXPECT_TRUE(reaches(angle, 0, {1, 0}));
  EXPECT_TRUE(reaches(angle, 1, {1, 0}));
  EXPECT_FALSE(reaches(angle, 0, {1.1, 0})) << "and no farther";
  EXPECT_FALSE(reaches(angle, 0, {-0.1, 0})) << "nothing is there";
}

TEST(ExtentsOf, StayWhereTheyMeetAlready) {
  const std::vector<Curve> cross{line({0, 0}, {1, 0}), line({1, 0}, {1, 1}), line({2, -1}, {2, 1})};
  EXPECT_FALSE(reaches(cross, 0, {1.1, 0})) << "the second line ends it";
  EXPECT_TRUE(reaches(cross, 1, {1, 0}));
}

TEST(ExtentsOf, ArcsGoOnAsWell) {
  const std::vector<Curve> slot{arc({0, 0}, 1, 120, 240), line({0.3, 1}, {2, 1})};
  EXPECT_TRUE(reaches(slot, 0, {0, 1}));
  EXPECT_TRUE(reaches(slot, 1, {0, 1}));
  const std::vector<Curve> cut{arc({0, 0}, 1, 100, 260), line({0.5, -2}, {0.5, 2})};
  const double height = std::sqrt(0.75);
  EXPECT_TRUE(reaches(cut, 0, {0.5, height}));
  EXPECT_TRUE(reaches(cut, 0, {0.5, -height}));
  EXPECT_FALSE(reaches(cut, 0, {1, 0}));
}

TEST(Merged, CurvesThatAreNearBecomeTheOneWithMorePoints) {
  Curve few = line({0, 0.001}, {1, 0.001});
  few.count = 3;
  const std::vector<Curve> curves = merged({few, line({2, 0}, {3, 0}), line({0, 0.1}, {1, 0.1})}, 0.01);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0].offset, 0);
  EXPECT_EQ(curves[0].points.size(), 42U) << "of both";
}

TEST(PiecesOf, OfATurnedDrawingEndOnTheAxis) {
  const Curve slope = line({-1, 0}, {3, 4});
  for (const bool is_turned : {false, true}) {
    const std::vector<ProfileSegment> pieces = pieces_of(slope, {slope.along({-1, 0}), slope.along({3, 4})}, is_turned);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_TRUE(pieces[0].start.isApprox(is_turned ? Vector2d(0, 1) : Vector2d(-1, 0), 1e-12));
  }
  EXPECT_TRUE(pieces_of(slope, {slope.along({-1, 0}), slope.along({-0.5, 0.5})}, true).empty());
  const Curve circle = arc({0.5, 2}, 1, -180, 180);
  double length = 0;
  for (const ProfileSegment& piece : pieces_of(circle, {std::numbers::pi, 3 * std::numbers::pi}, true)) {
    EXPECT_GE(bounds_of(std::span(&piece, 1)).min().x(), 0);
    EXPECT_TRUE(piece.start.x() == 0 || piece.end.x() == 0);
    length += piece.length();
  }
  EXPECT_NEAR(length, 4 * std::numbers::pi / 3, 1e-9) << "two thirds of the circle";
}

/// The points of a whole circle end a little before it, and its least x and y within other points.
TEST(WithEndsOfCircles, TheBoxGrowsWhereAnArcWithPointsEnds) {
  const std::vector<Curve> curves{arc({2, 2}, 1, 3, 357), arc({-5, -5}, 8.01, 200, 250), line({0, 0}, {0, 3.02})};
  const Eigen::AlignedBox2d seen(Vector2d(0, 0), Vector2d(2.99, 2.9));
  const Eigen::AlignedBox2d grown = with_ends_of_circles(seen, curves, 0.02);
  EXPECT_TRUE(grown.min().isZero());
  EXPECT_EQ(grown.max(), Vector2d(3, 2.9)) << "the top is too far, the other arc's right end has no points";
}

TEST(WithClosedGaps, CirclesGrowUntilTheyTouch) {
  const std::vector<Curve> curves{line({-1, 1}, {1, 1}), arc({0, 0}, 0.995, 0, 359)};
  EXPECT_NEAR(with_closed_gaps(curves, 0.05, 0.01)[1].offset, 1, 1e-12);
  EXPECT_EQ(with_closed_gaps(curves, 0.05, 0.001)[1].offset, 0.995) << "too far";
}

}  // namespace
}  // namespace cloud2csg
