#include <gtest/gtest.h>

#include "io/step/host.hpp"
#include "io/step/load_kernel.hpp"
#include "shape/mesh/model_extent.hpp"
#include "step_module/read_back.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg::brep {
namespace {

/// Says that one node has twice the volume that it has, so that its operation counts as failed.
class DoubtfulHost : public ModelHost {
 public:
  using ModelHost::ModelHost;

  std::optional<VolumeEstimate> volume_of(std::size_t node) const override {
    std::optional<VolumeEstimate> estimate = ModelHost::volume_of(node);
    if (node == doubted && estimate) estimate->volume *= 2;
    return estimate;
  }

  std::size_t doubted = 0;
};

TEST(FailingNode, IsNamedAndGetsFacets) {
  const PrimitiveSet primitives{test::placed("plate", Box{.size = {4, 4, 1}}, {0, 0, 0}),
                                test::placed("ball", Sphere{.radius = 1}, {0, 0, 0}),
                                test::placed("rod", Cylinder{.radius = 0.25, .height = 4}, {1.5, 1.5, 0})};
  const CsgTree tree = parse_tree("plate - (ball & plate) | rod", primitives);
  const Model model{.primitives = primitives, .tree = tree};
  const AlignedBox extent = model_extent(model);
  KernelJob job;
  job.plan = plan_solid(tree);
  job.levels = levels_of(job.plan);
  job.extent = extent;
  job.size = extent.diagonal().norm();
  job.format = KernelFormat::brep;
  job.file = std::filesystem::temp_directory_path() / "cloud2csg_failing_node.brep";
  job.names = {"plate", "ball", "rod"};
  const BrepOptions options;
  const RunContext run;
  DoubtfulHost host(job, model, extent, options, run);
  host.doubted = job.plan.nodes[job.plan.root].kept.front();
  ASSERT_EQ(to_text(tree_of(job.plan, host.doubted), primitives), "plate - (ball & plate)");

  KernelResult result;
  load_kernel().run(&job, &host, &result);
  const test::ReadBack read = test::read_brep(job.file);
  std::filesystem::remove(job.file);
  EXPECT_EQ(result.error, "");
  ASSERT_EQ(result.failures.size(), 1U);
  EXPECT_EQ(result.failures[0].node, host.doubted);
  EXPECT_NE(result.failures[0].reason.find("volume"), std::string::npos) << result.failures[0].reason;
  EXPECT_TRUE(read.is_valid);
  EXPECT_GT(result.faces, 50U);
  constexpr double k_pi = 3.14159265358979;
  EXPECT_NEAR(read.volume / (16 - k_pi * (1 - 1.0 / 12) + k_pi / 4 * 3 / 4), 1, 0.01);
}

}  // namespace
}  // namespace cloud2csg::brep
