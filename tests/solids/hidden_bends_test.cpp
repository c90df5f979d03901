#include "raw/solids/hidden_bends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_pipe_spacing = 0.1;
constexpr double k_quarter = std::numbers::pi / 2;

/// A pipe with a quarter of a bend in the xy plane, from (3, 0, 0) to (0, 3, 0), and straight on along y from (3, -4,
/// 0). Its outside was seen, and the end of its bore.
struct Pipe {
  PointCloud cloud;
  std::vector<DetectedSurface> surfaces;

  void add(std::size_t surface, const Vector3d& place) {
    surfaces[surface].points.push_back(static_cast<std::uint32_t>(cloud.size()));
    const Vector3d out = normal(surfaces[surface].surface, place);
    cloud.positions.push_back(place);
    cloud.normals.push_back(out);
    cloud.sensor_positions.push_back(place + 10 * out);
  }

  /// `turns`: how much of the way around the outside of the bend was seen, from its outer edge on.
  explicit Pipe(double turns = 1) {
    const Surface bend{.type = SurfaceType::torus, .axis = Vector3d::UnitZ(), .radius = 3, .minor_radius = 1};
    const Surface leg{.type = SurfaceType::cylinder, .position = {3, -2, 0}, .axis = Vector3d::UnitY(), .radius = 1};
    Surface bore = leg;
    bore.radius = 0.7;
    bore.concave = true;
    for (const Surface& surface : {bend, leg, bore}) surfaces.push_back({.surface = surface, .points = {}});
    for (double turn = 0; turn < 2 * std::numbers::pi; turn += k_pipe_spacing) {
      const double x = 3 + std::cos(turn);
      for (double angle = 0; angle < k_quarter && turn < 2 * std::numbers::pi * turns; angle += k_pipe_spacing / 3) {
        add(0, {x * std::cos(angle), x * std::sin(angle), std::sin(turn)});
      }
      for (double y = -4; y < 0; y += k_pipe_spacing) add(1, {x, y, std::sin(turn)});
      for (double y = -4; y < -3; y += k_pipe_spacing) add(2, {3 + 0.7 * std::cos(turn), y, 0.7 * std::sin(turn)});
    }
  }

  [[nodiscard]] std::vector<HiddenBend> hidden_bends() const {
    Scale scale;
    scale.diagonal = 8;
    scale.spacing = k_pipe_spacing;
    scale.noise = 0.001;
    return find_hidden_bends(cloud, surfaces, scale);
  }
};

TEST(HiddenBends, FollowTheOutside) {
  const Pipe pipe;
  const std::vector<HiddenBend> bends = pipe.hidden_bends();
  ASSERT_EQ(bends.size(), 1U);
  EXPECT_EQ(bends[0].inside.surface.type, SurfaceType::torus);
  EXPECT_TRUE(bends[0].inside.surface.concave);
  EXPECT_NEAR(bends[0].inside.surface.minor_radius, 0.7, 1e-9);
  EXPECT_NEAR(bends[0].inside.surface.radius, 3, 1e-9);
  const PointCloud& hidden = bends[0].hidden;
  const double area = k_quarter * 3 * 2 * std::numbers::pi * 0.7;
  EXPECT_NEAR(static_cast<double>(hidden.size()), area / (k_pipe_spacing * k_pipe_spacing),
              0.15 * area / (k_pipe_spacing * k_pipe_spacing));
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const Vector3d place = hidden.positions[i];
    EXPECT_NEAR(signed_distance(bends[0].inside.surface, place), 0, 1e-9);
    EXPECT_GE(std::min(place.x(), place.y()), -1e-6);
    const Vector3d middle = 3 * Vector3d(place.x(), place.y(), 0).normalized();
    EXPECT_GT(hidden.normals[i].dot(middle - place), 0.69);
    EXPECT_GT((hidden.sensor_positions[i] - place).dot(hidden.normals[i]), 0);
  }
}

TEST(HiddenBends, AreOnlyWhereTheOutsideIs) {
  const Pipe gutter(0.5);  // above the xy plane
  const std::vector<HiddenBend> bends = gutter.hidden_bends();
  ASSERT_EQ(bends.size(), 1U);
  for (std::size_t i = 0; i < bends[0].hidden.size(); ++i) {
    EXPECT_GT(bends[0].hidden.positions[i].z(), -0.5);
  }
}

TEST(HiddenBends, ReplacePiecesOfTheInside) {
  Pipe pipe;
  Surface inside{
      .type = SurfaceType::torus, .axis = Vector3d::UnitZ(), .radius = 3, .minor_radius = 0.7, .concave = true};
  pipe.surfaces.push_back({.surface = inside, .points = {}});
  for (double angle = 0.05; angle < 0.3; angle += k_pipe_spacing / 3) {
    for (double turn = 0; turn < 2 * std::numbers::pi; turn += k_pipe_spacing) {
      const double x = 3 + 0.7 * std::cos(turn);
      pipe.add(3, {x * std::cos(angle), x * std::sin(angle), 0.7 * std::sin(turn)});
    }
  }
  const std::vector<HiddenBend> bends = pipe.hidden_bends();
  ASSERT_EQ(bends.size(), 1U);
  EXPECT_EQ(bends[0].inside.points, pipe.surfaces[3].points);
  for (std::size_t i = 0; i < bends[0].hidden.size(); ++i) {
    const Vector3d place = bends[0].hidden.positions[i];
    EXPECT_GT(std::atan2(place.y(), place.x()), 0.2);
  }
}

TEST(HiddenBends, AreNotBehindTheFloorOfABlindHole) {
  Pipe pipe;
  pipe.surfaces.push_back(
      {.surface = {.type = SurfaceType::plane, .position = {3, -2.5, 0}, .axis = -Vector3d::UnitY()}, .points = {}});
  pipe.surfaces[2].surface.position.y() = -3.5;
  for (int k = 0; k < 20; ++k) pipe.add(3, {2.6 + 0.04 * k, -2.5, 0.1});
  EXPECT_TRUE(pipe.hidden_bends().empty());
}

TEST(HiddenBends, HaveTheRadiusOfTheBoreNextToThem) {
  Pipe pipe;  // with an orifice farther away
  Surface orifice = pipe.surfaces[2].surface;
  orifice.radius = 0.3;
  pipe.surfaces.push_back({.surface = orifice, .points = {}});
  for (double turn = 0; turn < 2 * std::numbers::pi; turn += k_pipe_spacing) {
    pipe.add(3, {3 + 0.3 * std::cos(turn), -3.9, 0.3 * std::sin(turn)});
  }
  const std::vector<HiddenBend> bends = pipe.hidden_bends();
  ASSERT_EQ(bends.size(), 1U);
  EXPECT_EQ(bends[0].inside.surface.minor_radius, 0.7);
}

TEST(HiddenBends, MayBeShort) {
  Pipe pipe;
  std::erase_if(pipe.surfaces[0].points, [&](std::uint32_t i) {
    const Vector3d place = pipe.cloud.positions[i];
    return std::atan2(place.y(), place.x()) > 0.15;
  });
  const std::vector<HiddenBend> bends = pipe.hidden_bends();
  ASSERT_EQ(bends.size(), 1U);
  pipe.surfaces[0].points.resize(1);
  EXPECT_TRUE(pipe.hidden_bends().empty());
}

TEST(HiddenBends, NeedABoreAndSensors) {
  Pipe rod;
  rod.surfaces.pop_back();
  EXPECT_TRUE(rod.hidden_bends().empty());
  Pipe sampled;
  sampled.cloud.sensor_positions = {};
  EXPECT_TRUE(sampled.hidden_bends().empty());
}

}  // namespace
}  // namespace cloud2csg
