#include <gtest/gtest.h>

#include <stop_token>

#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

/// Spheres and boxes of M0 that are too large, cylinders that are too thin: by two percent.
PrimitiveSet wrong_sizes(PrimitiveSet primitives) {
  for (Primitive& primitive : primitives) {
    if (auto* sphere = std::get_if<Sphere>(&primitive.shape)) sphere->radius *= 1.02;
    if (auto* box = std::get_if<Box>(&primitive.shape)) box->size *= 1.02;
    if (auto* cylinder = std::get_if<Cylinder>(&primitive.shape)) cylinder->radius *= 0.98;
  }
  return primitives;
}

TEST(ExtractRefined, ExplainsThePointsBetter) {
  const Model model = test::paper_model("m0");
  const PointCloud cloud = sample_surface(model, {.count = 8000, .noise = 0.005, .seed = 1});
  const PrimitiveSet given = wrong_sizes(model.primitives);
  const Extraction plain = extract_csg(cloud, given);
  const Extraction refined = extract_refined_csg(cloud, given);
  ASSERT_TRUE(refined.statistics.refine);
  EXPECT_TRUE(refined.statistics.refine->is_taken);
  EXPECT_LT(refined.statistics.fit.rms_distance, 0.8 * plain.statistics.fit.rms_distance);
  EXPECT_EQ(refined.model.primitives.size(), given.size());
  EXPECT_GT(refined.statistics.seconds.refine, 0);
  EXPECT_GE(refined.statistics.seconds.extraction, refined.statistics.seconds.refine);
  EXPECT_GT(test::membership_iou(refined.tree(), *model.tree, model.primitives), 0.99);
}

TEST(ExtractRefined, IsTheSameForAnyThreads) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(model, {.count = 3000, .noise = 0.005, .seed = 2});
  const PrimitiveSet given = wrong_sizes(model.primitives);
  const Extraction one = extract_refined_csg(cloud, given, {}, {}, {.threads = 1});
  const Extraction two = extract_refined_csg(cloud, given, {}, {}, {.threads = 2});
  EXPECT_EQ(one.tree(), two.tree());
  for (std::size_t p = 0; p < given.size(); ++p) {
    EXPECT_EQ(one.model.primitives[p].pose.position, two.model.primitives[p].pose.position);
  }
}

TEST(ExtractRefined, StopsBeforeTheFirstTreeAsExtractDoes) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(model, {.count = 1000, .noise = 0.005, .seed = 2});
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)extract_refined_csg(cloud, model.primitives, {}, {}, {.stop = stop.get_token()}), Cancelled);
}

TEST(ExtractRefined, SaysThatItsTimeWasOver) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(model, {.count = 2000, .noise = 0.005, .seed = 2});
  const PrimitiveSet given = wrong_sizes(model.primitives);
  const Extraction result = extract_refined_csg(cloud, given, {.time_limit_seconds = 1e-9});
  EXPECT_FALSE(result.statistics.complete);
  EXPECT_EQ(result.statistics.warnings.back(), "stopped early: this is the best tree so far");
  EXPECT_EQ(result.model.primitives[0].pose.position, given[0].pose.position);
}

/// A stop while refining leaves the tree that was there.
TEST(ExtractRefined, StoppedWhileRefiningGivesTheFirstTree) {
  const Model model = test::paper_model("m2");
  const PointCloud cloud = sample_surface(model, {.count = 2000, .noise = 0.005, .seed = 2});
  const PrimitiveSet given = wrong_sizes(model.primitives);
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token(), .on_progress = [&stop](const Progress& progress) {
                         if (progress.stage == "refine") stop.request_stop();
                       }};
  const Extraction result = extract_refined_csg(cloud, given, {}, {}, run);
  EXPECT_FALSE(result.statistics.complete);
  EXPECT_EQ(result.model.primitives[0].pose.position, given[0].pose.position);
  EXPECT_EQ(result.tree(), extract_csg(cloud, given).tree());
}

}  // namespace
}  // namespace cloud2csg
