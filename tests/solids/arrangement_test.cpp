#include "raw/solids/arrangement.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "core/base/disjoint_sets.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

constexpr double k_resolution = 1e-9;

void add_circle(std::vector<ProfileSegment>& pieces, const Vector2d& centre, double radius) {
  const Vector2d arm(radius, 0);
  pieces.push_back(segment_between(centre - arm, 1, centre + arm));
  pieces.push_back(segment_between(centre + arm, 1, centre - arm));
}

void add_box(std::vector<ProfileSegment>& pieces, const Vector2d& low, const Vector2d& high) {
  const std::array corners{low, Vector2d(high.x(), low.y()), high, Vector2d(low.x(), high.y())};
  for (std::size_t i = 0; i < 4; ++i) pieces.push_back(segment_between(corners[i], 0, corners[(i + 1) % 4]));
}

Vector2d random_place(RandomStream& random) {
  const double x = random.uniform(-1, 1);
  return {x, random.uniform(-1, 1)};
}

/// In a box from -4 to 4. Every second scene has its corners and radii on a grid, so that curves touch and overlap.
std::vector<ProfileSegment> random_pieces(RandomStream& random) {
  std::vector<ProfileSegment> pieces;
  add_box(pieces, {-4, -4}, {4, 4});
  const bool is_even = random.chance(0.5);
  const auto place = [&]() -> Vector2d {
    const Vector2d free = random_place(random);
    return is_even ? Vector2d((4 * free).array().round() / 4) : free;
  };
  const std::size_t count = 1 + random.below(8);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d from = place();
    const Vector2d to = place();
    if (random.chance(0.3)) {
      add_circle(pieces, from, is_even ? 0.25 * static_cast<double>(1 + random.below(4)) : random.uniform(0.1, 1));
    } else if ((from - to).norm() > 0.1) {
      const bool is_line = random.chance(0.5);
      pieces.push_back(segment_between(from, is_line ? 0.0 : is_even ? 1.0 : random.uniform(-1, 1), to));
    }
  }
  return pieces;
}

RC_GTEST_PROP(CurveArrangement, HasAsManyFacesAsEulerSays, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const CurveArrangement found = arrange(random_pieces(random), k_resolution);
  DisjointSets parts(found.vertices.size());
  std::set<std::uint32_t> vertices;
  for (const CurveArrangement::Edge& edge : found.edges) {
    parts.join(edge.start, edge.end);
    vertices.insert({edge.start, edge.end});
  }
  std::set<std::size_t> components;
  for (const std::uint32_t vertex : vertices) components.insert(parts.root(vertex));
  RC_ASSERT(vertices.size() + found.areas.size() == found.edges.size() + 1 + components.size());
  RC_ASSERT(std::abs(std::accumulate(found.areas.begin(), found.areas.end(), 0.0) - 64) < 1e-6);
  for (std::size_t face = 1; face < found.areas.size(); ++face) RC_ASSERT(found.areas[face] > 0);
}

RC_GTEST_PROP(CurveArrangement, EdgesHaveTheirFacesBesideThem, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const CurveArrangement found = arrange(random_pieces(random), k_resolution);
  const FaceLocator locator(found);
  for (const CurveArrangement::Edge& edge : found.edges) {
    const Vector2d outward = 1e-7 * edge.segment.normal(0.37);
    const Vector2d place = edge.segment.at(0.37);
    RC_ASSERT(locator.face_at(place - outward) == edge.left);
    RC_ASSERT(locator.face_at(place + outward) == edge.right);
  }
}

RC_GTEST_PROP(CurveArrangement, AFaceIsWhereItsEdgesSay, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const CurveArrangement found = arrange(random_pieces(random), k_resolution);
  const FaceLocator locator(found);
  for (int k = 0; k < 100; ++k) {
    const Vector2d place = 4.2 * random_place(random);
    std::uint32_t by_edges = 0;
    for (std::uint32_t face = 1; face < found.areas.size(); ++face) {
      std::vector<ProfileSegment> boundary;
      for (const CurveArrangement::Edge& edge : found.edges) {
        if ((edge.left == face) != (edge.right == face)) boundary.push_back(edge.segment);
      }
      if (is_inside(boundary, place)) by_edges = face;
    }
    RC_ASSERT(locator.face_at(place) == by_edges);
  }
}

TEST(CurveArrangement, CurvesThatNearlyTouchMeetInOneVertex) {
  std::vector<ProfileSegment> pieces;
  add_box(pieces, {-2, -2}, {2, 2});
  add_circle(pieces, {0, 0}, 1);
  for (const double height : {1 + 0.5e-3, 1 - 0.5e-3}) {
    std::vector<ProfileSegment> with_line = pieces;
    with_line.push_back(segment_between({-2, height}, 0, {2, height}));
    const CurveArrangement found = arrange(with_line, 1e-3);
    EXPECT_EQ(found.areas.size(), 4U) << "outside, below with the circle in it, the circle, above";
    EXPECT_EQ(arrange(with_line, 1e-6).areas.size(), height > 1 ? 4U : 5U);
  }
}

TEST(CurveArrangement, EndsThatBoundNothingAreLeftOut) {
  std::vector<ProfileSegment> pieces;
  add_box(pieces, {0, 0}, {2, 2});
  pieces.push_back(segment_between({1, -1}, 0, {1, 3}));     // through
  pieces.push_back(segment_between({0.5, 0.5}, 0, {5, 1}));  // ends in the left face
  const CurveArrangement found = arrange(pieces, k_resolution);
  EXPECT_EQ(found.areas.size(), 4U);
  EXPECT_EQ(arrange({}, k_resolution).areas.size(), 1U);
  pieces.push_back(segment_between({0.3, 0.3}, 0, {0.3, 0.3}));
  EXPECT_EQ(arrange(pieces, k_resolution).edges.size(), found.edges.size()) << "a piece without length";
}

}  // namespace
}  // namespace cloud2csg
