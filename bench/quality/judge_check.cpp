#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/compare.hpp"
#include "measure.hpp"
#include "quality/parts.hpp"

namespace cloud2csg::bench {
namespace {

constexpr int k_resolution = 128;

/// The true tree without one primitive, for each primitive.
std::vector<CsgTree> faulty_trees(const Model& model) {
  std::vector<PrimitiveIndex> all(model.primitives.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  std::vector<CsgTree> trees;
  for (std::size_t gone = 0; gone < all.size(); ++gone) {
    std::vector<PrimitiveIndex> kept = all;
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(gone));
    trees.push_back(restrict_to(*model.tree, kept));
  }
  return trees;
}

std::vector<TableCell> check(const std::string& name) {
  const Model model = shipped_model(name);
  Stopwatch watch;
  const Judge judge(model.primitives, *model.tree);
  const double making = watch.lap();
  double most = 0, sum = 0, sampled_seconds = 0, compared_seconds = 0;
  const std::vector<CsgTree> trees = faulty_trees(model);
  for (const CsgTree& tree : trees) {
    watch.lap();
    const double sampled = judge.intersection_over_union(tree);
    sampled_seconds += watch.lap();
    const Shape3d truth{.model = model};
    const Shape3d result{.model = Model{.primitives = model.primitives, .tree = tree}};
    const double compared =
        compare(truth, result, {.resolution = k_resolution, .surface_samples = 2}).intersection_over_union.value_or(0);
    compared_seconds += watch.lap();
    most = std::max(most, std::abs(sampled - compared));
    sum += std::abs(sampled - compared);
  }
  const auto count = static_cast<double>(trees.size());
  return {name,
          count,
          fmt::format("{:.5f}", sum / count),
          fmt::format("{:.5f}", most),
          milliseconds_text(1e3 * making),
          fmt::format("{:.3f}", 1e3 * sampled_seconds / count),
          milliseconds_text(1e3 * compared_seconds / count)};
}

}  // namespace

void print_judge_check() {
  Table table{
      .name = "judge",
      .title = "Sampled IoU",
      .note = fmt::format("The IoU by {} places, as in the other tables, less that of compare() by {} x {} "
                          "columns.\nThe trees are the true one without one of its primitives, for each of them.",
                          Judge::k_places, k_resolution, k_resolution),
      .columns = {"model", "trees", "mean difference", "largest difference", "places, ms", "sampled, ms a tree",
                  "compare, ms a tree"}};
  for (const char* name : {"m0", "m1", "m2", "m3"}) table.rows.push_back(check(name));
  fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
