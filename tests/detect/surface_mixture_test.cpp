#include "raw/detect/surface_mixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_mixture_noise = 0.01;
constexpr AgreementLimits k_mixture_limits{.distance = 0.03, .noise = k_mixture_noise, .cosine = 0.8};

struct PlaceCase {
  std::string name;
  std::function<Vector3d(RandomStream&)> draw;
  SurfaceType type;
  std::size_t surfaces;
  double radius;
};

void PrintTo(const PlaceCase& param, std::ostream* out) {
  *out << param.name;
}

Vector3d on_unit_circle(RandomStream& random) {
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  return {std::cos(angle), std::sin(angle), 0};
}

const std::vector<PlaceCase> k_place_cases{
    {"plane", [](RandomStream& r) { return Vector3d(r.uniform(-1, 1), r.uniform(-1, 1), 0); }, SurfaceType::plane, 1,
     0},
    {"wall",
     [](RandomStream& r) {
       return Vector3d(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(0, 1) < 0.4 ? 0 : 4 * k_mixture_noise);
     },
     SurfaceType::plane, 2, 0},
    {"pin", [](RandomStream& r) { return Vector3d(0.03 * on_unit_circle(r) + r.uniform(0, 0.4) * Vector3d::UnitZ()); },
     SurfaceType::cylinder, 1, 0.03},
    {"ring", [](RandomStream& r) { return Vector3d(0.3 * on_unit_circle(r) + r.uniform(0, 0.2) * Vector3d::UnitZ()); },
     SurfaceType::cylinder, 1, 0.3},
    {"ball", [](RandomStream& r) { return Vector3d(0.08 * Vector3d(r.normal(), r.normal(), r.normal()).normalized()); },
     SurfaceType::sphere, 1, 0.08}};

class FitMixture : public testing::TestWithParam<PlaceCase> {};

TEST_P(FitMixture, ToPositionsWithSomeOutliers) {
  const PlaceCase& param = GetParam();
  RandomStream random(17);
  std::vector<Vector3d> positions;
  for (int k = 0; k < 400; ++k) {
    positions.push_back(param.draw(random) +
                        k_mixture_noise * Vector3d(random.normal(), random.normal(), random.normal()));
    if (k % 20 == 0) positions.back() += 0.2 * Vector3d(random.normal(), random.normal(), random.normal());
  }
  const std::optional<SurfaceMixture> mixture = fit_mixture(positions, 12, k_mixture_limits);
  ASSERT_TRUE(mixture);
  EXPECT_EQ(mixture->surfaces.size(), param.surfaces);
  EXPECT_EQ(mixture->surfaces[0].type, param.type);
  EXPECT_NEAR(mixture->surfaces[0].radius, param.radius, 0.006);
  EXPECT_LT(mixture->shares().back(), 0.07);
}

INSTANTIATE_TEST_SUITE_P(Shapes, FitMixture, testing::ValuesIn(k_place_cases),
                         [](const auto& param) { return param.param.name; });

/// With one plane and no outlier, the cost is that of the distances and of the plane's parameters.
TEST(CostOfMixture, IsThatOfTheDistancesAndParameters) {
  RandomStream random(5);
  constexpr double k_count = 200;
  std::vector<Vector3d> positions;
  double squares = 0;
  for (int k = 0; k < k_count; ++k) {
    positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0.5 * k_mixture_noise * random.normal());
    squares += std::pow(positions.back().z() / k_mixture_noise, 2);
  }
  SurfaceMixture mixture{.surfaces = {{.type = SurfaceType::plane}}};
  mixture.surface_of = nearest_surfaces(mixture.surfaces, positions, 3 * k_mixture_noise);
  ASSERT_EQ(std::ranges::count(mixture.surface_of, 0U), 200);
  // The outlier that there may be adds a likelihood of up to e^-4.5 / 200 to each position.
  EXPECT_NEAR(cost_of(mixture, positions, mixture.shares(), k_mixture_noise), squares / 2 + 1.5 * std::log(k_count),
              0.2);
  EXPECT_LT(cost_of(mixture, positions, mixture.shares(), k_mixture_noise), squares / 2 + 1.5 * std::log(k_count));
}

TEST(CostOfMixture, HasItsOwnNoise) {
  RandomStream random(6);
  std::vector<Vector3d> positions;
  for (int k = 0; k < 500; ++k) {
    positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 4 * k_mixture_noise * random.normal());
  }
  SurfaceMixture mixture{.surfaces = {{.type = SurfaceType::plane}}};
  mixture.surface_of.assign(positions.size(), 0);
  const double expected = 500 * (0.5 + std::log(4.0)) + 1.5 * std::log(500.0);
  EXPECT_NEAR(cost_of(mixture, positions, mixture.shares(), k_mixture_noise), expected, 0.05 * expected);
}

}  // namespace
}  // namespace cloud2csg
