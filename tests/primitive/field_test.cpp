#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "cloud2csg/primitive.hpp"
#include "core/primitive/profile.hpp"
#include "primitive/random_primitives.hpp"

namespace cloud2csg {
namespace {

using testing::any_analytic_shape;
using testing::any_exact_primitive;
using testing::any_pose;
using testing::any_primitive;
using testing::distance_at;
using testing::gradient_at;
using testing::points_near;
using testing::vector_within;

/// By the angle that the paths, cut into short lines, turn around the place.
bool contains(const Profile& profile, const Eigen::Vector2d& place) {
  constexpr int k_lines = 1000;
  double turns = 0;
  for (const ClosedPath& path : profile.paths) {
    double angle = 0;
    for (const ProfileSegment& s : segments_of(path)) {
      Eigen::Vector2d from = s.start - place;
      for (int k = 1; k <= k_lines; ++k) {
        const Eigen::Vector2d to = s.at(k / double{k_lines}) - place;
        angle += std::atan2(cross(from, to), from.dot(to));
        from = to;
      }
    }
    turns += std::abs(std::round(angle / (2 * std::numbers::pi)));
  }
  return std::lround(turns) % 2 == 1;
}

/// Membership straight from each solid's definition, in its own frame.
struct Contains {
  Eigen::Vector3d p;

  bool operator()(const Box& box) const { return (2 * p.cwiseAbs().array() < box.size.array()).all(); }
  bool operator()(const Sphere& sphere) const { return p.norm() < sphere.radius; }
  bool operator()(const Cylinder& cylinder) const {
    return std::hypot(p.x(), p.y()) < cylinder.radius && 2 * std::abs(p.z()) < cylinder.height;
  }
  bool operator()(const Cone& cone) const {
    const double t = p.z() / cone.height + 0.5;
    return t > 0 && t < 1 && std::hypot(p.x(), p.y()) < cone.radius_bottom + t * (cone.radius_top - cone.radius_bottom);
  }
  bool operator()(const Torus& torus) const {
    return std::hypot(std::hypot(p.x(), p.y()) - torus.major_radius, p.z()) < torus.minor_radius;
  }
  bool operator()(const HalfSpace& /*half_space*/) const { return p.z() < 0; }
  bool operator()(const Polytope& polytope) const {
    return std::ranges::all_of(polytope.planes, [&](const Plane& plane) { return plane.normal.dot(p) < plane.offset; });
  }
  bool operator()(const Extrusion& extrusion) const {
    return 2 * std::abs(p.z()) < extrusion.height && contains(extrusion.profile, p.head<2>());
  }
  bool operator()(const Revolution& revolution) const {
    const double turn = std::atan2(p.y(), p.x());
    const double angle_deg = (turn < 0 ? turn + 2 * std::numbers::pi : turn) / std::numbers::pi * 180;
    return angle_deg < revolution.angle_deg && contains(revolution.profile, {std::hypot(p.x(), p.y()), p.z()});
  }
  bool operator()(const Expression& /*expression*/) const {
    return Eigen::Vector3d(p.x(), p.y() / 1.5, 2 * p.z()).norm() < 1;  // any_expression()
  }
};

RC_GTEST_PROP(SignedDistance, IsNegativeInsideOnly, ()) {
  Primitive primitive = any_primitive();
  primitive.displacement.reset();
  const Points points = points_near(primitive, 32);
  const std::vector<double> distance = signed_distance(primitive, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool has_profile =
        primitive.shape.index() == Shape(Extrusion()).index() || primitive.shape.index() == Shape(Revolution()).index();
    if (std::abs(distance[i]) < (has_profile ? 1e-5 : 1e-12)) continue;  // arcs are cut into lines
    const bool inside = std::visit(Contains{primitive.pose.to_local(points[i])}, primitive.shape);
    RC_ASSERT((distance[i] < 0) == inside);
  }
}

/// Corners of a profile often lie in line with places, so that these are on chords of arcs and in line with edges.
RC_GTEST_PROP(SignedDistance, IsNegativeInsideProfilesOnAGrid, ()) {
  Profile profile;
  const int corners = testing::integer(3, 7);
  do {
    ClosedPath path;
    for (int k = 0; k < corners; ++k) {
      path.push_back({.point = Eigen::Vector2d(testing::integer(-4, 5), testing::integer(-4, 5)),
                      .bulge = std::array{0.0, 1.0, -1.0, 0.5}[static_cast<std::size_t>(testing::integer(0, 4))]});
    }
    profile.paths = {path};
  } while (!test::is_valid(profile));
  const Primitive solid{.id = "p", .shape = Extrusion{.profile = profile, .height = 2}};
  for (int x = -8; x <= 8; ++x) {
    for (int y = -8; y <= 8; ++y) {
      const double distance = testing::distance_at(solid, Eigen::Vector3d(x, y, 0));
      if (std::abs(distance) > 1e-4) RC_ASSERT((distance < 0) == contains(profile, Eigen::Vector2d(x, y)));
    }
  }
}

/// The distance of the nearest segment, each by itself.
double plain_distance(const Profile& profile, const Eigen::Vector2d& place, bool is_turned) {
  double least = std::numeric_limits<double>::infinity();
  for (const ProfileSegment& s : segments_of(profile)) {
    const bool is_on_axis = is_turned && !s.is_arc() && s.start.x() == 0 && s.end.x() == 0;
    if (!is_on_axis) least = std::min(least, (nearest(s, place) - place).norm());
  }
  return least;
}

RC_GTEST_PROP(SignedDistance, OfAProfileIsThatOfItsNearestSegment, ()) {
  Profile profile = test::any_profile(testing::real);
  // Some arcs are nearly lines.
  for (PathCorner& corner : profile.paths[0]) {
    if (testing::integer(0, 4) == 0) corner.bulge = testing::real(-1, 1) * std::pow(10.0, -testing::integer(2, 12));
  }
  if (!test::is_valid(profile)) profile = test::any_profile(testing::real);
  const Primitive extruded{.id = "e", .shape = Extrusion{.profile = profile, .height = 100}};
  double largest = 1;  // the plain distance from a large circle loses digits
  for (const ProfileSegment& s : segments_of(profile)) largest = std::max(largest, s.radius);
  const Revolution revolution = test::any_full_turn(testing::real);
  const Primitive turned{.id = "r", .shape = revolution};
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector2d place(testing::real(-2, 2), testing::real(-2, 2));
    const double found = std::abs(testing::distance_at(extruded, {place.x(), place.y(), 0}));
    RC_ASSERT(std::abs(found - plain_distance(profile, place, false)) < 1e-12 + 1e-15 * largest);
    const Eigen::Vector2d beside(testing::integer(0, 3) == 0 ? 0 : std::abs(place.x()), place.y());
    const double around = std::abs(testing::distance_at(turned, {0, beside.x(), beside.y()}));
    RC_ASSERT(std::abs(around - plain_distance(revolution.profile, beside, true)) < 1e-12);
  }
}

TEST(SignedDistance, OfAProfileHoldsFarFromItsOrigin) {
  const double far = 1e7;
  const ClosedPath path{{.point = {far, far}}, {.point = {far + 0.1, far}}, {.point = {far + 0.1, far + 0.1}}};
  const Primitive solid{.id = "p", .shape = Extrusion{.profile = {{path}}, .height = 10}};
  EXPECT_GT(gradient_at(solid, {far + 0.2, far + 0.05, 0}).x(), 0.99);
  EXPECT_LT(gradient_at(solid, {far + 0.05, far - 0.1, 0}).y(), -0.99);
}

RC_GTEST_PROP(SignedDistance, AddsTheProductOfSinesInTheSolidsFrame, ()) {
  Primitive displaced = any_primitive();
  Primitive base = displaced;
  base.displacement.reset();
  displaced.displacement = Displacement{.frequency = testing::real(0.1, 20)};
  const double k = displaced.displacement->frequency;
  const Points points = points_near(displaced, 16);
  const std::vector<double> with = signed_distance(displaced, points);
  const std::vector<double> without = signed_distance(base, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = k * displaced.pose.to_local(points[i]);
    const double expected = without[i] + std::sin(p.x()) * std::sin(p.y()) * std::sin(p.z());
    RC_ASSERT(std::abs(with[i] - expected) < 1e-12);
  }
}

RC_GTEST_PROP(SignedDistance, NeverChangesFasterThanThePoint, ()) {
  const Primitive primitive{.id = "p", .shape = any_analytic_shape(), .pose = any_pose()};
  const Points a = points_near(primitive, 16);
  const Points b = points_near(primitive, 16);
  const std::vector<double> fa = signed_distance(primitive, a);
  const std::vector<double> fb = signed_distance(primitive, b);
  for (std::size_t i = 0; i < a.size(); ++i) RC_ASSERT(std::abs(fa[i] - fb[i]) <= (a[i] - b[i]).norm() + 1e-13);
}

RC_GTEST_PROP(SignedDistance, LeadsToTheSurfaceAlongTheGradient, ()) {
  const Primitive primitive = any_exact_primitive();
  RC_ASSERT(has_exact_distance(primitive));
  const Points points = points_near(primitive, 16);
  const std::vector<double> distance = signed_distance(primitive, points);
  const Points slope = gradient(primitive, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    RC_ASSERT(std::abs(slope[i].norm() - 1) < 1e-12);
    RC_ASSERT(std::abs(distance_at(primitive, points[i] - distance[i] * slope[i])) < 1e-11);
  }
}

RC_GTEST_PROP(SignedDistance, OfAPolytopeIsExactInsideAndALowerBoundOutside, ()) {
  const Primitive primitive{.id = "q", .shape = testing::any_polytope(), .pose = any_pose()};
  const Points points = points_near(primitive, 16);
  const std::vector<double> distance = signed_distance(primitive, points);
  const Points slope = gradient(primitive, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double reached = distance_at(primitive, points[i] - distance[i] * slope[i]);
    // The foot on the nearest plane is on the solid when the point is inside; else it is on the plane, not before it.
    const bool holds = distance[i] < 0 ? std::abs(reached) < 1e-12 : reached > -1e-12;
    RC_ASSERT(holds);
  }
}

RC_GTEST_PROP(SignedDistance, MovesWithTheSolid, ()) {
  const Primitive primitive = any_primitive();
  const Pose motion = any_pose();
  Primitive moved = primitive;
  moved.pose = compose(motion, primitive.pose);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d point = primitive.pose.position + vector_within(3);
    const Eigen::Vector3d there = motion.to_world(point);
    RC_ASSERT(std::abs(distance_at(moved, there) - distance_at(primitive, point)) < 1e-12);
    const Eigen::Vector3d turned = motion.orientation * gradient_at(primitive, point);
    // On a ridge the two may take different sides; then the distance itself bends there.
    const Eigen::Vector3d beside = motion.orientation * gradient_at(primitive, point + Eigen::Vector3d::Constant(1e-9));
    if ((beside - turned).norm() < 1e-6) RC_ASSERT((gradient_at(moved, there) - turned).norm() < 1e-6);
  }
}

RC_GTEST_PROP(Gradient, IsTheSlopeOfTheDistance, ()) {
  const Primitive primitive = any_primitive();
  constexpr double k_step = 1e-6;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d point = primitive.pose.position + vector_within(3);
    const Eigen::Vector3d slope = gradient_at(primitive, point);
    Eigen::Vector3d expected;
    bool is_smooth = true;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = k_step * Eigen::Vector3d::Unit(axis);
      expected[axis] = (distance_at(primitive, point + step) - distance_at(primitive, point - step)) / (2 * k_step);
      is_smooth = is_smooth && (gradient_at(primitive, point + step) - slope).norm() < 1e-3 &&
                  (gradient_at(primitive, point - step) - slope).norm() < 1e-3;
    }
    if (is_smooth) RC_ASSERT((slope - expected).norm() < 1e-6);
  }
}

Extrusion square() {
  return {.profile = {{{{.point = {0, 0}}, {.point = {1, 0}}, {.point = {1, 1}}, {.point = {0, 1}}}}}, .height = 1};
}

Revolution ball() {
  return {{{{{.point = {0, -1}, .bulge = 1}, {.point = {0, 1}}}}}};
}

/// Solids and points of their own frame where the distance has no gradient.
class Degenerate : public ::testing::TestWithParam<std::tuple<Shape, Eigen::Vector3d, double>> {};

TEST_P(Degenerate, HasAUnitGradientAndTheRightDistance) {
  const auto& [shape, local, distance] = GetParam();
  // Unrotated, so that the point stays exactly where it is degenerate; a second time in a random position.
  for (const Pose& pose : {Pose{}, Pose{.position = {1, 2, 3}, .orientation = {0.5, 0.5, -0.5, 0.5}}}) {
    const Primitive primitive{.id = "p", .shape = shape, .pose = pose};
    const Eigen::Vector3d point = pose.to_world(local);
    EXPECT_NEAR(gradient_at(primitive, point).norm(), 1, 1e-12);
    EXPECT_NEAR(distance_at(primitive, point), distance, 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Loci, Degenerate,
    ::testing::Values(std::tuple(Shape(Sphere{1}), Eigen::Vector3d(0, 0, 0), -1.0),           // centre
                      std::tuple(Shape(Sphere{1}), Eigen::Vector3d(0, 1e-200, 0), -1.0),      // its square underflows
                      std::tuple(Shape(Box{{2, 2, 2}}), Eigen::Vector3d(0, 0, 0), -1.0),      // all faces equally near
                      std::tuple(Shape(Box{{2, 2, 2}}), Eigen::Vector3d(0.5, 0.5, 0), -0.5),  // before an edge
                      std::tuple(Shape(Box{{2, 2, 2}}), Eigen::Vector3d(1, 1, 1), 0.0),       // corner
                      std::tuple(Shape(Cylinder{1, 4}), Eigen::Vector3d(0, 0, 0), -1.0),      // axis
                      std::tuple(Shape(Cylinder{1, 4}), Eigen::Vector3d(0, 0, 3), 1.0),       // axis, above
                      std::tuple(Shape(Cylinder{1, 4}), Eigen::Vector3d(1, 0, 2), 0.0),       // rim
                      std::tuple(Shape(Cone{3, 0, 4}), Eigen::Vector3d(0, 0, 0), -1.2),       // axis, slant nearest
                      std::tuple(Shape(Cone{3, 0, 4}), Eigen::Vector3d(0, 0, 2), 0.0),        // apex
                      std::tuple(Shape(Cone{3, 0, 4}), Eigen::Vector3d(0, 0, 5), 3.0),        // above the apex
                      std::tuple(Shape(Cone{3, 0, 4}), Eigen::Vector3d(3, 0, -2), 0.0),       // rim
                      std::tuple(Shape(Cone{0, 3, 4}), Eigen::Vector3d(0, 0, -2), 0.0),       // apex below
                      std::tuple(Shape(Torus{2, 1}), Eigen::Vector3d(0, 0, 0), 1.0),          // axis
                      std::tuple(Shape(Torus{2, 1}), Eigen::Vector3d(2, 0, 0), -1.0),         // core circle
                      std::tuple(Shape(square()), Eigen::Vector3d(0, 0, 0), 0.0),             // corner
                      std::tuple(Shape(square()), Eigen::Vector3d(1, 0, 0.5), 0.0),           // corner and rim
                      std::tuple(Shape(square()), Eigen::Vector3d(0.5, 0.5, 0), -0.5),        // all faces equally near
                      std::tuple(Shape(ball()), Eigen::Vector3d(0, 0, 0), -1.0),              // centre of an arc
                      std::tuple(Shape(ball()), Eigen::Vector3d(0, 0, 1), 0.0),  // end of an arc on the axis
                      std::tuple(Shape(ball()), Eigen::Vector3d(0, 0, 3), 2.0),  // above
                      std::tuple(Shape(Expression{"sqrt(x^2+y^2+z^2)-1",
                                                  AlignedBox(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1))}),
                                 Eigen::Vector3d(0, 0, 0), -1.0)));

TEST(TypeName, IsThatOfModelFiles) {
  EXPECT_EQ(type_name(Box{{1, 1, 1}}), "box");
  EXPECT_EQ(type_name(Sphere{}), "sphere");
  EXPECT_EQ(type_name(Cylinder{}), "cylinder");
  EXPECT_EQ(type_name(Cone{}), "cone");
  EXPECT_EQ(type_name(Torus{}), "torus");
  EXPECT_EQ(type_name(HalfSpace{}), "half_space");
  EXPECT_EQ(type_name(Polytope{}), "polytope");
  EXPECT_EQ(type_name(Extrusion{}), "extrusion");
  EXPECT_EQ(type_name(Revolution{}), "revolution");
  EXPECT_EQ(type_name(Expression{}), "expression");
}

TEST(IsPlain, IsFalseForFormulasAndWhatIsDisplaced) {
  EXPECT_TRUE(is_plain({.id = "q", .shape = Polytope{}}));
  EXPECT_TRUE(is_plain({.id = "t", .shape = Torus{2, 1}}));
  EXPECT_FALSE(is_plain({.id = "e", .shape = Expression{}}));
  EXPECT_FALSE(is_plain({.id = "b", .shape = Box{{1, 1, 1}}, .displacement = Displacement{2}}));
}

TEST(HasExactDistance, IsFalseForWhatIsOnlyABound) {
  EXPECT_TRUE(has_exact_distance({.id = "c", .shape = Cone{1, 2, 3}}));
  EXPECT_TRUE(has_exact_distance({.id = "h", .shape = HalfSpace{}}));
  EXPECT_FALSE(has_exact_distance({.id = "q", .shape = Polytope{}}));
  EXPECT_FALSE(has_exact_distance({.id = "e", .shape = Expression{}}));
  EXPECT_FALSE(has_exact_distance({.id = "b", .shape = Box{{1, 1, 1}}, .displacement = Displacement{2}}));
}

/// Ranks and sums of fields need numbers everywhere, also where the formula has none.
TEST(SignedDistance, OfAnExpressionWithoutAValueIsFarOutside) {
  const AlignedBox bounds(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
  Points points;
  points.push_back({-3, 0, 0});
  points.push_back({0.5, 0, 0});
  for (const char* formula : {"sqrt(x+2)-2", "(x < -2) ? 1/0 : x-1"}) {
    const Primitive primitive{.id = "e", .shape = Expression{formula, bounds}};
    const std::vector<double> distances = signed_distance(primitive, points);
    EXPECT_TRUE(std::isfinite(distances[0])) << formula;
    EXPECT_GT(distances[0], 1e20) << formula;
    EXPECT_LT(distances[1], 0) << formula;
    EXPECT_TRUE(gradient(primitive, points)[0].allFinite()) << formula;
  }
}

}  // namespace
}  // namespace cloud2csg
