#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_narrow_noise = 0.01;
constexpr double k_narrow_thickness = 5 * k_narrow_noise;
constexpr double k_narrow_radius = 3 * k_narrow_noise;

/// A block with a feature that is a few standard deviations of the noise wide.
struct NarrowCase {
  std::string name;
  bool is_round;
  bool is_hollow;
};

void PrintTo(const NarrowCase& param, std::ostream* out) {
  *out << param.name;
}

test::Part block_with(const NarrowCase& param) {
  const Vector3d middle(0, 0, param.is_hollow ? 0.7 : 1.5);
  const Primitive block = test::placed("block", Box{{2, 2, 2}}, {0, 0, 0});
  const Primitive feature = param.is_round ? test::placed("feature", Cylinder{k_narrow_radius, 1}, middle)
                                           : test::placed("feature", Box{{k_narrow_thickness, 1, 1}}, middle);
  if (param.is_hollow) return test::without_others({block, feature});
  return {.primitives = {block, feature}, .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

bool is_in_feature(const Vector3d& place, const NarrowCase& param) {
  const double off = param.is_round ? place.head<2>().norm() : std::abs(place.x());
  const double height = param.is_hollow ? 1 - place.z() : place.z() - 1;
  return off < k_narrow_thickness + 3 * k_narrow_noise && std::abs(place.y()) < 0.6 && height > 3 * k_narrow_noise &&
         height < 1.1;
}

class NarrowFeature : public testing::TestWithParam<NarrowCase> {};

/// The estimated normals of such a feature are arbitrary: those of its sides are averaged.
TEST_P(NarrowFeature, IsFoundWithItsSideOfTheMaterial) {
  const NarrowCase& param = GetParam();
  PointCloud cloud = test::cloud_of(block_with(param), k_narrow_noise, 15'000);
  RandomStream random(7);
  std::size_t in_feature = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_in_feature(cloud.positions[i], param)) continue;
    ++in_feature;
    const Vector3d arbitrary = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const Vector3d flipped = (random.uniform(0, 1) < 0.5 ? 1 : -1) * Vector3d::UnitX();
    cloud.normals.set(i, param.is_round ? arbitrary : flipped);
  }
  std::size_t found = 0;
  std::size_t surfaces = 0;
  for (const DetectedSurface& s : test::detect(cloud, k_narrow_noise).surfaces) {
    const auto own = static_cast<std::size_t>(
        std::ranges::count_if(s.points, [&](std::uint32_t i) { return is_in_feature(cloud.positions[i], param); }));
    if (2 * own < s.points.size()) continue;
    found += own;
    ++surfaces;
    const Vector3d& position = s.surface.position;
    if (param.is_round) {
      EXPECT_EQ(s.surface.type, SurfaceType::cylinder);
      EXPECT_EQ(s.surface.concave, param.is_hollow);
      EXPECT_NEAR(s.surface.radius, k_narrow_radius, 0.15 * k_narrow_radius);
      EXPECT_LT(position.head<2>().norm(), k_narrow_noise);
    } else {
      EXPECT_EQ(s.surface.type, SurfaceType::plane);
      EXPECT_GT(std::abs(s.surface.axis.x()), 0.99);
      EXPECT_EQ(position.x() * s.surface.axis.x() < 0, param.is_hollow);
      EXPECT_NEAR(std::abs(position.x()), k_narrow_thickness / 2, k_narrow_noise / 2);
    }
  }
  EXPECT_EQ(surfaces, param.is_round ? 1U : 2U);
  EXPECT_GT(found, in_feature * 9 / 10);
}

const std::vector<NarrowCase> k_narrow_cases{
    {"wall", false, false}, {"gap", false, true}, {"pin", true, false}, {"bore", true, true}};
INSTANTIATE_TEST_SUITE_P(Shapes, NarrowFeature, testing::ValuesIn(k_narrow_cases),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace cloud2csg
