// Speed-up of the rank classes over walking the tree at each point: E(t) of the true tree over 150 k points.

#include <fmt/format.h>

#include <numeric>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_points = 150'000;
constexpr std::size_t k_evaluations = 1000;

void report(const std::string& name) {
  const Model model = shipped_model(name);
  const PointCloud cloud = paper_cloud(model, k_points, 1);
  const double noise = estimate_noise(cloud, model.primitives);
  std::vector<PrimitiveIndex> all(model.primitives.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  const std::vector<RankClassesRequest> requests{{.primitives = all, .all_points = true}};
  const PointPass pass = build_rank_classes(cloud, model.primitives, requests,
                                            {.tolerances = segmentation_tolerances({}, noise), .noise = noise});
  const RankClasses& table = pass.tables.front();

  std::vector<std::uint32_t> points(cloud.size());
  std::iota(points.begin(), points.end(), 0U);
  double plain_score = 0;
  const Timing plain = time_runs(
      5, [&] { plain_score = reference_objective(*model.tree, model.primitives, cloud, points, table.objective()); });
  RankScratch scratch;
  double fast_score = 0;
  const Timing fast = time_runs(9, [&] {
    for (std::size_t k = 0; k < k_evaluations; ++k) fast_score = table.score(*model.tree, scratch);
  });
  const double per_tree = fast.median / static_cast<double>(k_evaluations);
  fmt::print("| {:5} | {:10} | {:8} | {:9.1f} | {:10.3f} | {:9.0f} x | {:.1e} |\n", name, model.primitives.size(),
             table.class_count(), plain.median * 1e3, per_tree * 1e6, plain.median / per_tree,
             std::abs(fast_score - plain_score) / plain_score);
}

}  // namespace
}  // namespace cloud2csg::bench

int main() {
  fmt::print("E(t) of the true tree, {} points, one core, medians\n\n", cloud2csg::bench::k_points);
  fmt::print("| model | primitives | classes  | plain, ms | classes, us | ratio       | relative difference |\n");
  fmt::print("|-------|------------|----------|-----------|------------|-------------|---------|\n");
  for (const char* name : {"m0", "m1", "m2", "m3"}) cloud2csg::bench::report(name);
}
