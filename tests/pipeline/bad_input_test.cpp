#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

PrimitiveSet ball() {
  return {test::placed("ball", Sphere{1}, {0, 0, 0})};
}

PointCloud cloud_of_ball() {
  return sample_surface({.primitives = ball(), .tree = CsgTree::leaf(0)}, {.count = 300});
}

Error::Parts error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.parts();
  }
  ADD_FAILURE() << "no error";
  return {};
}

Error::Parts error_of(const PointCloud& cloud, const PrimitiveSet& primitives) {
  return error_of([&] { (void)extract_csg(cloud, primitives); });
}

TEST(BadInput, NoPoints) {
  EXPECT_EQ(error_of({}, ball()).expected, "the cloud has no points");
}

TEST(BadInput, NoNormals) {
  PointCloud cloud = cloud_of_ball();
  cloud.normals = {};
  const Error::Parts error = error_of(cloud, ball());
  EXPECT_NE(error.expected.find("no normals"), std::string::npos);
  EXPECT_NE(error.remedy.find("Compute normals"), std::string::npos);
}

TEST(BadInput, NumbersThatAreNotFiniteOrTooLarge) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1.7e308}) {
    PointCloud cloud = cloud_of_ball();
    cloud.positions.x[7] = bad;
    cloud.positions.x[8] = -bad;
    EXPECT_NE(error_of(cloud, ball()).expected.find("not finite"), std::string::npos) << bad;
  }
  PointCloud cloud = cloud_of_ball();
  cloud.normals.z[3] = std::nan("");
  EXPECT_NE(error_of(cloud, ball()).expected.find("not finite"), std::string::npos);
}

TEST(BadInput, NoPrimitives) {
  EXPECT_EQ(error_of(cloud_of_ball(), {}).expected, "there are no primitives");
}

TEST(BadInput, APrimitiveThatIsNone) {
  EXPECT_EQ(error_of(cloud_of_ball(), {test::placed("ball", Sphere{-1}, {0, 0, 0})}).where, "primitive 'ball': radius");
}

TEST(BadInput, ACloudFarFromEverything) {
  PointCloud cloud = cloud_of_ball();
  for (double& x : cloud.positions.x) x += 1e4;
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.normals.set(i, Eigen::Vector3d::UnitY());
  const Error::Parts error = error_of(cloud, ball());
  EXPECT_EQ(error.expected, "no point of the cloud is near any primitive");
  EXPECT_NE(error.remedy.find("units"), std::string::npos);
}

/// The same cloud with the normals as they were: the noise that is measured is as large as the gap.
TEST(BadInput, ACloudFarFromEverythingThatFacesIt) {
  PointCloud cloud = cloud_of_ball();
  for (double& x : cloud.positions.x) x += 1e4;
  const Error::Parts error = error_of(cloud, ball());
  EXPECT_EQ(error.expected, "no point of the cloud is near any primitive");
}

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

struct BadOption {
  const char* field;
  std::function<void(ExtractOptions&)> spoil;
};

std::vector<BadOption> bad_options() {
  return {
      {"segmentation.distance_tolerance", [](ExtractOptions& o) { o.segmentation.distance_tolerance = 0; }},
      {"segmentation.distance_tolerance", [](ExtractOptions& o) { o.segmentation.distance_tolerance = k_nan; }},
      {"segmentation.angle_tolerance_deg", [](ExtractOptions& o) { o.segmentation.angle_tolerance_deg = 0; }},
      {"segmentation.angle_tolerance_deg", [](ExtractOptions& o) { o.segmentation.angle_tolerance_deg = 91; }},
      {"segmentation.angle_tolerance_deg", [](ExtractOptions& o) { o.segmentation.angle_tolerance_deg = k_nan; }},
      {"objective.alpha", [](ExtractOptions& o) { o.objective.alpha = -1; }},
      {"objective.alpha", [](ExtractOptions& o) { o.objective.alpha = k_infinity; }},
      {"objective.beta", [](ExtractOptions& o) { o.objective.beta = 0; }},
      {"objective.beta", [](ExtractOptions& o) { o.objective.beta = k_infinity; }},
      {"objective.gamma", [](ExtractOptions& o) { o.objective.gamma = -1; }},
      {"objective.gamma", [](ExtractOptions& o) { o.objective.gamma = k_nan; }},
      {"overlap_tolerance", [](ExtractOptions& o) { o.overlap_tolerance = -1; }},
      {"time_limit_seconds", [](ExtractOptions& o) { o.time_limit_seconds = 0; }},
      {"time_limit_seconds", [](ExtractOptions& o) { o.time_limit_seconds = k_nan; }},
      {"search.population", [](ExtractOptions& o) { o.search.population = 1; }},
      {"search.elites", [](ExtractOptions& o) { o.search.elites = -1; }},
      {"search.elites", [](ExtractOptions& o) { o.search.elites = o.search.population; }},
      {"search.tournament", [](ExtractOptions& o) { o.search.tournament = 0; }},
      {"search.crossover_rate", [](ExtractOptions& o) { o.search.crossover_rate = 1.5; }},
      {"search.mutation_rate", [](ExtractOptions& o) { o.search.mutation_rate = -0.1; }},
      {"search.new_tree_rate", [](ExtractOptions& o) { o.search.new_tree_rate = k_nan; }},
      {"search.height_limit", [](ExtractOptions& o) { o.search.height_limit = 0; }},
      {"search.idle_generations", [](ExtractOptions& o) { o.search.idle_generations = 0; }},
      {"search.generation_limit", [](ExtractOptions& o) { o.search.generation_limit = 0; }},
      {"search.listing_limit", [](ExtractOptions& o) { o.search.listing_limit = 6; }},
      {"search.trust", [](ExtractOptions& o) { o.search.trust = 2; }},
      {"search.restarts", [](ExtractOptions& o) { o.search.restarts = -1; }},
  };
}

TEST(BadInput, EachOptionIsNamed) {
  for (const BadOption& bad : bad_options()) {
    ExtractOptions options;
    bad.spoil(options);
    const Error::Parts error = error_of([&] { validate(options); });
    EXPECT_EQ(error.where, bad.field);
    EXPECT_FALSE(error.expected.empty()) << bad.field;
    EXPECT_THROW((void)extract_csg(cloud_of_ball(), ball(), options), Error) << bad.field;
  }
}

TEST(BadInput, TheDefaultsAreValid) {
  EXPECT_NO_THROW(validate(ExtractOptions{}));
  EXPECT_NO_THROW(validate(paper_options()));
}

TEST(BadInput, ManyPointsOnNoPrimitiveAreDoubtful) {
  const PrimitiveSet primitives{test::placed("known", Box{{1, 1, 1}}, {0, 0, 0}),
                                test::placed("missing", Sphere{0.5}, {2, 0, 0})};
  const PointCloud cloud = sample_surface({.primitives = primitives, .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))},
                                          {.count = 2000, .noise = 0.002});
  const Extraction result = extract_csg(cloud, {primitives[0]});
  EXPECT_EQ(result.tree(), CsgTree::leaf(0));
  EXPECT_TRUE(result.statistics.warnings.empty());
  EXPECT_EQ(result.statistics.verdict.grade, Grade::doubtful);
  EXPECT_GT(result.statistics.unassigned_points, 400U);
}

/// So few points that some formulas miss them; all of them are on primitives.
TEST(BadInput, PointsOffTheResultAreDoubtful) {
  const Model model = test::paper_model("m0");
  std::size_t doubted = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PointCloud cloud = sample_surface(model, {.count = 6, .noise = 0.01, .seed = seed});
    const Extraction result = extract_csg(cloud, model.primitives);
    const ExtractStatistics& statistics = result.statistics;
    if (is_constant(result.tree()) || 10 * statistics.unassigned_points > statistics.points) continue;
    const double tolerance = segmentation_tolerances({}, statistics.noise).distance;
    const bool is_off = statistics.fit.p95_distance > tolerance;
    const bool is_doubtful = statistics.verdict.grade != Grade::good;
    EXPECT_GE(is_doubtful, is_off) << seed;
    doubted += is_doubtful ? 1 : 0;
  }
  EXPECT_GT(doubted, 0U);
  EXPECT_LT(doubted, 20U);
}

}  // namespace
}  // namespace cloud2csg
