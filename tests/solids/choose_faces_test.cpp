#include "raw/solids/choose_faces.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stop_token>

#include "core/base/random.hpp"
#include "raw/solids/outline.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// A box of 3 x 3 cells.
Drawing grid() {
  std::vector<ProfileSegment> pieces;
  for (int k = 0; k <= 3; ++k) {
    pieces.push_back(segment_between(Vector2d(k, 0), 0, Vector2d(k, 3)));
    pieces.push_back(segment_between(Vector2d(0, k), 0, Vector2d(3, k)));
  }
  Drawing drawing{.arrangement = arrange(pieces, 1e-9), .curve_of_edge = {}, .price_of_edge = {}};
  for (const CurveArrangement::Edge& edge : drawing.arrangement.edges) drawing.curve_of_edge.push_back(edge.piece);
  drawing.price_of_edge.assign(drawing.arrangement.edges.size(), 0.0);
  return drawing;
}

FaceSet faces_at(const Drawing& drawing, std::initializer_list<Vector2d> places) {
  const FaceLocator locator(drawing.arrangement);
  FaceSet faces(drawing.arrangement.areas.size(), 0);
  for (const Vector2d& place : places) faces[locator.face_at(place)] = 1;
  return faces;
}

TEST(SegmentsOf, CountsMaximalPartsOfACurve) {
  const Drawing drawing = grid();
  EXPECT_EQ(segments_of(drawing, faces_at(drawing, {{0.5, 0.5}})), 4U);
  EXPECT_EQ(segments_of(drawing, faces_at(drawing, {{0.5, 0.5}, {1.5, 0.5}})), 4U) << "a bar";
  EXPECT_EQ(segments_of(drawing, faces_at(drawing, {{0.5, 0.5}, {1.5, 0.5}, {0.5, 1.5}})), 6U) << "an angle";
  EXPECT_EQ(segments_of(drawing, FaceSet(drawing.arrangement.areas.size(), 0)), 0U);
  std::vector<ProfileSegment> circle{segment_between({-1, 0}, 1, {1, 0}), segment_between({1, 0}, 1, {-1, 0})};
  Drawing disc{.arrangement = arrange(circle, 1e-9), .curve_of_edge = {0, 0}, .price_of_edge = {0, 0}};
  EXPECT_EQ(segments_of(disc, {0, 1}), 1U) << "a closed curve";
}

constexpr double k_corner_price = 0.05;

/// Random gains and prices, and the best of all sets of faces.
struct Choice {
  explicit Choice(std::uint64_t seed) {
    RandomStream random(seed);
    for (double& price : drawing.price_of_edge) price = random.chance(0.5) ? 0.0 : random.uniform(0, 0.3);
    for (std::size_t face = 1; face < gains.size(); ++face) gains[face] = random.uniform(-1, 1);
    for (std::size_t bits = 0; bits < 512; ++bits) {
      FaceSet faces(gains.size(), 0);
      for (std::size_t k = 0; k < 9; ++k) faces[k + 1] = (bits >> k) & 1U;
      if (net(0, faces) > net(0, best)) best = faces;
      if (bits > 0 && is_writable(drawing, faces)) {
        best_with_corners = std::max(best_with_corners, net(k_corner_price, faces));
      }
    }
  }

  [[nodiscard]] double net(double price_of_segment, const FaceSet& faces) const {
    return net_gain(drawing, gains, price_of_segment, faces);
  }

  Drawing drawing = grid();
  std::vector<double> gains = std::vector<double>(drawing.arrangement.areas.size(), 0.0);
  FaceSet best = FaceSet(drawing.arrangement.areas.size(), 0);  ///< where corners cost nothing
  double best_with_corners = 0;                                 ///< net gain, of sets without pinches
};

RC_GTEST_PROP(ChooseFaces, FindsTheBestOfAllSetsWhereCornersCostNothing, ()) {
  const Choice choice(*rc::gen::arbitrary<std::uint32_t>());
  const FaceSet without_corners = choose_faces(choice.drawing, choice.gains, 0);
  if (is_writable(choice.drawing, choice.best)) {
    RC_ASSERT(std::abs(choice.net(0, without_corners) - choice.net(0, choice.best)) < 1e-9);
  }
  for (const FaceSet& faces : {choose_faces(choice.drawing, choice.gains, k_corner_price), without_corners}) {
    RC_ASSERT(faces[0] == 0);
    RC_ASSERT(faces == FaceSet(faces.size(), 0) || is_writable(choice.drawing, faces));
  }
}

TEST(ChooseFaces, LosesLittleWhereCornersCost) {
  double lost = 0;
  double best = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Choice choice(seed);
    best += choice.best_with_corners;
    lost += choice.best_with_corners -
            choice.net(k_corner_price, choose_faces(choice.drawing, choice.gains, k_corner_price));
  }
  EXPECT_LT(lost, 0.05 * best) << lost / best;
}

TEST(ChooseFaces, EndsEarlyOnAStop) {
  // The cut takes two cells that meet in a vertex. Without a stop, a third joins them, or one goes.
  const Drawing drawing = grid();
  const FaceSet pinched = faces_at(drawing, {{0.5, 0.5}, {1.5, 1.5}});
  std::vector<double> gains(pinched.size(), -1);
  for (std::size_t face = 0; face < gains.size(); ++face) gains[face] = pinched[face] != 0 ? 1.0 : -1.0;
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token()};
  EXPECT_NE(choose_faces(drawing, gains, 0, run), pinched);
  stop.request_stop();
  EXPECT_EQ(choose_faces(drawing, gains, 0, run), pinched);
}

TEST(OutlineOf, JoinsEdgesOfACurve) {
  const Drawing drawing = grid();
  const Profile angle = outline_of(drawing, faces_at(drawing, {{0.5, 0.5}, {1.5, 0.5}, {0.5, 1.5}}));
  ASSERT_EQ(angle.paths.size(), 1U);
  EXPECT_EQ(angle.paths[0].size(), 6U);
  EXPECT_NEAR(area_of(angle), 3, 1e-12);
  FaceSet ring(drawing.arrangement.areas.size(), 1);
  ring[0] = 0;
  for (std::size_t face = 1; face < ring.size(); ++face) ring[face] ^= faces_at(drawing, {{1.5, 1.5}})[face];
  const Profile frame = outline_of(drawing, ring);
  EXPECT_EQ(frame.paths.size(), 2U);
  EXPECT_NEAR(area_of(frame), 8, 1e-12);
}

TEST(OutlineOf, ACircleIsTwoHalves) {
  std::vector<ProfileSegment> pieces{segment_between({-1, 0}, 1, {1, 0}), segment_between({1, 0}, 1, {-1, 0}),
                                     segment_between({0, -3}, 0, {0, 3}), segment_between({-3, 0.2}, 0, {3, 0.2})};
  Drawing drawing{.arrangement = arrange(pieces, 1e-9), .curve_of_edge = {}, .price_of_edge = {}};
  constexpr std::array<std::uint32_t, 4> k_curves{0, 0, 1, 2};
  for (const CurveArrangement::Edge& edge : drawing.arrangement.edges)
    drawing.curve_of_edge.push_back(k_curves[edge.piece]);
  FaceSet disc(drawing.arrangement.areas.size(), 1);
  disc[0] = 0;
  const Profile profile = outline_of(drawing, disc);
  ASSERT_EQ(profile.paths.size(), 1U);
  EXPECT_EQ(profile.paths[0].size(), 2U);
  EXPECT_TRUE(is_circle(segments_of(profile.paths[0])));
  validate_profile(profile);
  EXPECT_NEAR(area_of(profile), std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace cloud2csg
