// Rate of correct solids and tree sizes over 20 clouds and searches per model: the default and each of its additions.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/extract.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_points = 20'000;
constexpr std::uint64_t k_seeds = 20;

struct Setting {
  std::string name;
  ExtractOptions options;
};

std::vector<Setting> settings() {
  std::vector<Setting> all{{"default", {}}, {"default without cells", {.cell_trust = 2}}, {"paper", paper_options()}};
  const auto add = [&all](const char* name, auto&& change) {
    Setting setting{name, paper_options()};
    change(setting.options);
    all.push_back(setting);
  };
  add("paper + 100 idle generations", [](ExtractOptions& o) { o.search.idle_generations = 100; });
  add("paper + listing up to 4", [](ExtractOptions& o) { o.search.listing_limit = 4; });
  add("paper + seeds", [](ExtractOptions& o) { o.search.seeds = true; });
  add("paper + local search at the end", [](ExtractOptions& o) { o.search.polish = true; });
  add("paper + restarts", [](ExtractOptions& o) {
    o.search.trust = GaOptions{}.trust;
    o.search.restarts = GaOptions{}.restarts;
  });
  add("paper + polish of the whole", [](ExtractOptions& o) { o.polish = true; });
  all.push_back({"baseline, default search", {.strategy = Strategy::baseline}});
  ExtractOptions paper_baseline = paper_options();
  paper_baseline.strategy = Strategy::baseline;
  all.push_back({"baseline of the paper", paper_baseline});
  return all;
}

struct Recovery {
  std::size_t right = 0;
  double worst_iou = 1;
  double worst_ratio = 0, mean_ratio = 0;
  std::size_t fall_backs = 0;
  double milliseconds = 0;
};

Recovery recover(const Model& model, const ExtractOptions& setting) {
  Recovery recovery;
  std::vector<double> seconds;
  for (std::uint64_t seed = 1; seed <= k_seeds; ++seed) {
    const PointCloud cloud = paper_cloud(model, k_points, seed);
    ExtractOptions options = setting;
    options.seed = seed;
    options.parallel = Parallel::none;
    const Extraction result = extract_csg(cloud, model.primitives, options);
    const Shape3d truth{.model = model};
    const Shape3d found{.model = result.model};
    const double iou =
        compare(truth, found, {.resolution = 96, .surface_samples = 1000}).intersection_over_union.value_or(0);
    const double ratio = static_cast<double>(result.model.tree->size()) / static_cast<double>(model.tree->size());
    recovery.right += iou >= 0.999 ? 1 : 0;
    recovery.worst_iou = std::min(recovery.worst_iou, iou);
    recovery.worst_ratio = std::max(recovery.worst_ratio, ratio);
    recovery.mean_ratio += ratio / static_cast<double>(k_seeds);
    for (const MergeWay way : result.statistics.merge.ways) {
      recovery.fall_backs += way != MergeWay::paper && way != MergeWay::single ? 1 : 0;
    }
    seconds.push_back(result.statistics.seconds.extraction);
  }
  std::ranges::sort(seconds);
  recovery.milliseconds = seconds[seconds.size() / 2] * 1e3;
  return recovery;
}

}  // namespace
}  // namespace cloud2csg::bench

int main() {
  using namespace cloud2csg::bench;
  fmt::print("Recovery, {} points, noise 0.01, {} seeds, one core. right: IoU >= 0.999; ratio: nodes / true nodes;\n",
             k_points, k_seeds);
  fmt::print("fall-backs: components whose paper merge did not go through or did not hold; ms: median extraction\n\n");
  fmt::print(
      "| model | setting                         | right | worst IoU | mean ratio | worst ratio | fall-backs | ms      "
      "|\n");
  fmt::print(
      "|-------|---------------------------------|-------|-----------|------------|-------------|------------|---------"
      "|\n");
  for (const char* name : {"m0", "m1", "m2", "m3"}) {
    const cloud2csg::Model model = shipped_model(name);
    for (const Setting& setting : settings()) {
      const Recovery r = recover(model, setting.options);
      fmt::print("| {:5} | {:31} | {:2}/{:2} | {:9.5f} | {:10.3f} | {:11.3f} | {:10} | {:7.1f} |\n", name, setting.name,
                 r.right, k_seeds, r.worst_iou, r.mean_ratio, r.worst_ratio, r.fall_backs, r.milliseconds);
      std::fflush(stdout);
    }
  }
}
