#include "raw/solids/charts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "cloud2csg/sample.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// A regular prism along z. Its sides have this distance from the axis.
Polytope prism(int sides, double distance, double height) {
  Polytope prism{.planes = {{.normal = Vector3d::UnitZ(), .offset = height / 2},
                            {.normal = -Vector3d::UnitZ(), .offset = height / 2}}};
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    prism.planes.push_back({.normal = {std::cos(angle), std::sin(angle), 0}, .offset = distance});
  }
  return prism;
}

bool is_drawn(const std::vector<Chart>& charts, const Vector3d& direction) {
  return std::ranges::any_of(charts, [&](const Chart& chart) {
    return !chart.is_turned && std::abs((chart.frame.orientation * Vector3d::UnitZ()).dot(direction)) > 0.9999;
  });
}

/// Any two of the larger planes share a direction, too.
TEST(MakeCharts, DrawASmallPrismThatSticksOutOfALargeOne) {
  Primitive small = test::placed("small", prism(3, 0.3, 5), {0, 0, 0.4});
  small.pose.orientation = Eigen::Quaterniond(0.6, 0.48, 0.64, 0);
  const PrimitiveSet solids{test::placed("large", prism(11, 2, 2), {0, 0, 0}), small};
  const PointCloud cloud =
      sample_surface({.primitives = solids, .tree = unite_all(std::vector{CsgTree::leaf(0), CsgTree::leaf(1)})},
                     {.count = 20'000, .seed = 1});
  const std::vector<DetectedSurface> surfaces = test::known_surfaces(solids, cloud, 1e-6);
  const std::vector<Chart> charts = make_charts(cloud.positions, surfaces, {.tolerance = 0.01, .spacing = 0.05});
  EXPECT_TRUE(is_drawn(charts, Vector3d::UnitZ()));
  EXPECT_TRUE(is_drawn(charts, small.pose.orientation * Vector3d::UnitZ()));
}

}  // namespace
}  // namespace cloud2csg
