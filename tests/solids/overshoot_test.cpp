#include "raw/solids/overshoot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>
#include <string>
#include <vector>

#include "cloud2csg/compare.hpp"
#include "core/base/random.hpp"
#include "support/any_profile.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

const AlignedBox k_part(Vector3d(-4, -3, -1), Vector3d(4, 3, 1));
const double k_percent = 0.01 * k_part.diagonal().norm();

/// A plate, 8 x 6 x 2, with something taken from it.
PrimitiveSet with_overshooting_cut(const Primitive& cut) {
  return with_overshoots({test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0}), cut},
                         subtract(CsgTree::leaf(0), CsgTree::leaf(1)), 0, k_part);
}

void expect_box(const AlignedBox& box, const Vector3d& min, const Vector3d& max) {
  EXPECT_TRUE(box.min().isApprox(min, 1e-9)) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(max, 1e-9)) << box.max().transpose();
}

TEST(Overshoot, ASlotReachesBeyondThePartWhereItIsOpen) {
  const Vector3d low(-4, -1, 0);
  const Vector3d high(1, 1, 1);
  for (const Eigen::Quaterniond& turn :
       {Eigen::Quaterniond::Identity(), Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitX())),
        Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitY()))}) {
    const Vector3d size = (turn.conjugate() * (high - low)).cwiseAbs();
    Primitive slot = test::placed("slot", Box{size}, 0.5 * (low + high));
    slot.pose.orientation = turn;
    const PrimitiveSet solids = with_overshooting_cut(slot);
    EXPECT_TRUE(std::holds_alternative<Box>(solids[1].shape));
    expect_box(bounds(solids[0]), k_part.min(), k_part.max());
    expect_box(bounds(solids[1]), low - Vector3d(k_percent, 0, 0), high + Vector3d(0, 0, k_percent));
  }
}

TEST(Overshoot, AStoppedRunLeavesTheSolidsAsTheyAre) {
  const PrimitiveSet solids{test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0}),
                            test::placed("bore", Cylinder{.radius = 1, .height = 2}, {1, 1, 0})};
  const CsgTree tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1));
  std::stop_source stop;
  const auto height_of_bore = [&] {
    const PrimitiveSet result = with_overshoots(solids, tree, 0, k_part, {.stop = stop.get_token()});
    return std::get<Cylinder>(result[1].shape).height;
  };
  EXPECT_GT(height_of_bore(), 2);
  stop.request_stop();
  EXPECT_EQ(height_of_bore(), 2);
}

TEST(Overshoot, BoresAndCountersinksReachBeyondThePart) {
  const PrimitiveSet bored = with_overshooting_cut(test::placed("bore", Cylinder{.radius = 1, .height = 2}, {1, 1, 0}));
  ASSERT_TRUE(std::holds_alternative<Cylinder>(bored[1].shape));
  EXPECT_NEAR(std::get<Cylinder>(bored[1].shape).radius, 1, 1e-9);
  EXPECT_NEAR(std::get<Cylinder>(bored[1].shape).height, 2 + 2 * k_percent, 1e-9);
  const PrimitiveSet sunk =
      with_overshooting_cut(test::placed("sink", Cone{.radius_bottom = 1, .radius_top = 2, .height = 1}, {1, 0, 0.5}));
  ASSERT_TRUE(std::holds_alternative<Cone>(sunk[1].shape));
  const Cone cone = std::get<Cone>(sunk[1].shape);
  EXPECT_NEAR(cone.radius_bottom, 1, 1e-9);
  EXPECT_NEAR(cone.radius_top, 2 + k_percent, 1e-9) << "the cone goes on at its angle";
  EXPECT_NEAR(cone.height, 1 + k_percent, 1e-9);
}

/// A disc that cuts an end off, its axis far from the part, in any direction from its own zero angle.
TEST(Overshoot, SolidsFarLargerThanThePartReachBeyondItOnlyWhereNothingIs) {
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
    for (const double side : {-1.0, 1.0}) {
      Primitive disc = test::placed("disc", Cylinder{.radius = 1000, .height = 2}, {side * 1003, 0, 0});
      disc.pose.orientation = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
      const PrimitiveSet solids = with_overshooting_cut(disc);
      ASSERT_TRUE(std::holds_alternative<Cylinder>(solids[1].shape));
      EXPECT_NEAR(std::get<Cylinder>(solids[1].shape).radius, 1000, 1e-9) << angle;
      EXPECT_NEAR(std::get<Cylinder>(solids[1].shape).height, 2 + 2 * k_percent, 1e-9) << angle;
    }
  }
}

/// The same with a sector just wide enough for the part, on either side of its own zero angle.
TEST(Overshoot, SectorsFarLargerThanThePartReachBeyondItOnlyWhereNothingIs) {
  const ClosedPath path{{.point = {0, -1}}, {.point = {1000, -1}}, {.point = {1000, 1}}, {.point = {0, 1}}};
  for (const double side : {0.0, 180.0}) {
    for (const double angle_deg : {1.0, 90.0, 200.0}) {
      Primitive sector = test::placed("sector", Revolution{.profile = {.paths = {path}}, .angle_deg = angle_deg},
                                      {side > 0 ? 1003.0 : -1003.0, 0, 0});
      sector.pose.orientation = Eigen::AngleAxisd((side - 0.5 * angle_deg) * std::acos(-1) / 180, Vector3d::UnitZ());
      const PrimitiveSet solids = with_overshooting_cut(sector);
      const auto* const result = std::get_if<Revolution>(&solids[1].shape);
      ASSERT_TRUE(result != nullptr);
      EXPECT_NEAR(bounds_of(result->profile).max().x(), 1000, 1e-9) << side << ' ' << angle_deg;
      EXPECT_NEAR(bounds_of(result->profile).max().y(), 1 + k_percent, 1e-9) << side << ' ' << angle_deg;
    }
  }
}

TEST(Overshoot, SolidsThatTouchOverlapAfterwards) {
  const PrimitiveSet solids = with_overshoots({test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0}),
                                               test::placed("boss", Cylinder{.radius = 1, .height = 2}, {0, 0, 2})},
                                              unite(CsgTree::leaf(0), CsgTree::leaf(1)), 0, k_part);
  expect_box(bounds(solids[1]), {-1, -1, 1 - k_percent}, {1, 1, 3});
}

/// The bend moves first, and the bar then shares no face with it any more.
TEST(Overshoot, ABendReachesIntoTheBarThatGoesOn) {
  const ClosedPath square{{.point = {1.5, -0.5}}, {.point = {2.5, -0.5}}, {.point = {2.5, 0.5}}, {.point = {1.5, 0.5}}};
  const Revolution quarter{.profile = {.paths = {square}}, .angle_deg = 90};
  const Primitive bend = test::placed("bend", quarter, {0, 0, 0});
  Primitive bar = test::placed("bar", Box{{1, 1, 2}}, {2, -1, 0});
  bar.pose.orientation = Eigen::AngleAxisd(std::acos(-1) / 2, Vector3d::UnitX());
  const AlignedBox part = bounds(bend).merged(bounds(bar));
  const CsgTree tree = unite(CsgTree::leaf(0), CsgTree::leaf(1));
  const PrimitiveSet solids = with_overshoots({bend, bar}, tree, 0, part);
  const double turn = std::get<Revolution>(solids[0].shape).angle_deg - 90;
  EXPECT_NEAR(turn / 180 * std::acos(-1) * 2.5, 0.01 * part.diagonal().norm(), 1e-9);
  EXPECT_NEAR(bounds(solids[0]).min().x(), 0, 1e-9) << "the other end is free";
  EXPECT_EQ(std::get<Box>(solids[1].shape).size.z(), 2);
}

/// The greatest overshoot is half a radian at the ring.
TEST(Overshoot, ASectorStaysLessThanAFullTurn) {
  const ClosedPath square{{.point = {0.1, -0.1}}, {.point = {0.2, -0.1}}, {.point = {0.2, 0.1}}, {.point = {0.1, 0.1}}};
  const PrimitiveSet solids{test::placed("ring", Revolution{{.paths = {square}}, 350}, {0, 0, 0}),
                            test::placed("half", Box{{8, 3, 2}}, {0, 1.5, 0}),
                            test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0})};
  const CsgTree tree = unite(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  const PrimitiveSet moved = with_overshoots(solids, tree, 0, k_part);
  EXPECT_LT(std::get<Revolution>(moved[0].shape).angle_deg, 360);
  EXPECT_NO_THROW(validate(moved[0]));
}

TEST(Overshoot, GivenSolidsStay) {
  const PrimitiveSet given{test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0}),
                           test::placed("bore", Cylinder{.radius = 1, .height = 2}, {1, 1, 0})};
  const PrimitiveSet solids = with_overshoots(given, subtract(CsgTree::leaf(0), CsgTree::leaf(1)), 2, k_part);
  EXPECT_EQ(std::get<Cylinder>(solids[1].shape).height, 2);
}

/// A gap between teeth whose inner and outer sides are arcs.
TEST(Overshoot, ArcsMoveAlongTheirNeighbours) {
  const double s = std::sqrt(8.0);
  const double inner = std::tan(std::asin(1 / 3.0) / 2);
  const double outer = std::tan(std::asin(1 / 4.0) / 2);
  const Profile gap{.paths = {{{.point = {s, -1}, .bulge = 0},
                               {.point = {std::sqrt(15.0), -1}, .bulge = outer},
                               {.point = {std::sqrt(15.0), 1}, .bulge = 0},
                               {.point = {s, 1}, .bulge = -inner}}}};
  PrimitiveSet ring{test::placed("disc", Cylinder{.radius = 4, .height = 1}, {0, 0, 0}),
                    test::placed("hole", Cylinder{.radius = 3, .height = 1}, {0, 0, 0}),
                    test::placed("gap", Extrusion{.profile = gap, .height = 0.6}, {0, 0, 0})};
  const CsgTree tree = subtract(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  const PrimitiveSet solids = with_overshoots(ring, tree, 0, bounds(ring[0]));
  const double by = 0.01 * bounds(ring[0]).diagonal().norm();
  const ClosedPath& path = std::get<Extrusion>(solids[2].shape).profile.paths.at(0);
  ASSERT_EQ(path.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d corner = path[k].point + solids[2].pose.position.head<2>();
    EXPECT_NEAR(corner.norm(), k == 0 || k == 3 ? 3 - by : 4 + by, 1e-9);
    EXPECT_NEAR(std::abs(corner.y()), 1, 1e-9) << "the walls stay";
  }
  EXPECT_NEAR(std::get<Extrusion>(solids[2].shape).height, 0.6, 1e-9) << "so do floor and ceiling";
}

TEST(Overshoot, ThinWallsNearACutStay) {
  // A rim of two thousandths of the diagonal stands half a percent beside the plate.
  const Primitive slot = test::placed("slot", Box{{4, 2, 2}}, {-2, 0, 0});
  const Primitive rim = test::placed("rim", Box{{0.002 / 0.01 * k_percent, 6, 2}}, {-4 - 0.5 * k_percent, 0, 0});
  const CsgTree body = unite(CsgTree::leaf(0), CsgTree::leaf(2));
  const PrimitiveSet solids = with_overshoots({test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0}), slot, rim},
                                              subtract(body, CsgTree::leaf(1)), 0, k_part);
  EXPECT_GE(bounds(solids[1]).min().x(), bounds(rim).max().x());
  EXPECT_LT(bounds(solids[1]).min().x(), -4);
}

TEST(Overshoot, ThinLayersCount) {
  // The bore ends a thousandth below the top, where only the hole in the profile is left.
  const Profile ring{.paths = {test::circle_path({0, 0}, 3), test::circle_path({0, 0}, 1)}};
  const Primitive body = test::placed("body", Extrusion{.profile = ring, .height = 4}, {0, 0, 0});
  const Primitive bore = test::placed("bore", Cylinder{.radius = 1, .height = 3.98}, {0, 0, -0.02});
  const PrimitiveSet solids =
      with_overshoots({body, bore}, subtract(CsgTree::leaf(0), CsgTree::leaf(1)), 0, bounds(body));
  for (const ClosedPath& path : std::get<Extrusion>(solids[0].shape).profile.paths) {
    const double radius = path[0].point.norm();
    EXPECT_TRUE(std::abs(radius - 3) < 1e-9 || std::abs(radius - 1) < 1e-9) << radius;
  }
}

TEST(Overshoot, RandomSolidsStayWhatTheyAre) {
  std::size_t different = 0;
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomStream random(seed);
    PrimitiveSet solids{test::placed("plate", Box{{8, 6, 2}}, {0, 0, 0})};
    CsgTree tree = CsgTree::leaf(0);
    for (PrimitiveIndex k = 1; k <= 6; ++k) {
      const Vector3d place(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-1, 1));
      const double size = random.uniform(0.5, 2);
      solids.push_back(random.chance(0.5) ? test::placed("box", Box{{size, 1, 2}}, place)
                                          : test::placed("pin", Cylinder{.radius = 0.5 * size, .height = 2}, place));
      solids.back().id += std::to_string(k);
      if (random.chance(0.3)) solids.back().pose.position.z() = 0;
      tree = random.chance(0.5) ? unite(tree, CsgTree::leaf(k)) : subtract(tree, CsgTree::leaf(k));
    }
    const AlignedBox part(Vector3d(-6, -5, -3), Vector3d(6, 5, 3));
    const PrimitiveSet moved = with_overshoots(solids, tree, 0, part);
    Points points;
    for (int i = 0; i < 5000; ++i) {
      points.push_back({random.uniform(-6, 6), random.uniform(-5, 5), random.uniform(-3, 3)});
    }
    const std::vector<double> before = implicit_value(tree, solids, points);
    const std::vector<double> after = implicit_value(tree, moved, points);
    for (std::size_t i = 0; i < before.size(); ++i) different += (before[i] < 0) != (after[i] < 0) ? 1 : 0;
    count += before.size();
  }
  // Slivers between the probes may be lost.
  EXPECT_LE(different, count / 10'000) << different;
}

}  // namespace
}  // namespace cloud2csg
