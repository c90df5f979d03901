#include <fmt/format.h>

#include <array>

#include "cloud2csg/sample.hpp"
#include "quality/parts.hpp"
#include "quality/random_model.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_points_per_primitive_scanned = 2000;
constexpr std::array<std::size_t, 3> k_views{4, 8, 20};

/// The default, and variants without evidence beyond the points.
std::vector<Setting> scan_settings() {
  return {{"auto", {}},
          {"no lines of sight", {.cell_labels = {.sight = 0}}},
          {"absence as without sensors", {.cell_labels = {.absence_in_scans = 1}}},
          {"no evidence of absence", {.cell_labels = {.absence = 0}}},
          {"partitions instead", {.cell_trust = 2}}};
}

Task make_scan_task(std::uint64_t seed, std::size_t views) {
  const RandomModel drawn = draw_model(Family::random, seed);
  const Model model = make_model(drawn);
  PointCloud cloud = scan_model(model, {.views = views,
                                        .count = k_points_per_primitive_scanned * model.primitives.size(),
                                        .with_normals = true,
                                        .seed = seed});
  return make_task(model, std::move(cloud), std::make_shared<Judge>(model.primitives, *model.tree), seed);
}

}  // namespace

void print_scans(const QualityOptions& options) {
  RunOptions run = options.run;
  run.settings = scan_settings();
  Table table{
      .name = "scans",
      .title = "Virtual scans",
      .note = fmt::format("{} models of family random, scanned with the default defects; {} points a primitive, "
                          "true normals.\n{}",
                          options.scan_models, k_points_per_primitive_scanned, legend(k_right)),
      .columns = {"views", "setting", "right", "no larger", "worst IoU", "mean IoU", "mean ratio", "ms"}};
  for (const std::size_t views : k_views) {
    const auto make = [&](std::size_t i) { return make_scan_task(options.first_seed + i, views); };
    const auto outcomes = run_tasks(fmt::format("scans, {} views", views), options.scan_models, make, run);
    for (std::size_t s = 0; s < outcomes.size(); ++s) {
      const Summary summary = summarise(outcomes[s], k_right);
      table.rows.push_back({std::to_string(views), run.settings[s].name, share_text(summary.right, summary),
                            share_text(summary.no_larger, summary), iou_text(summary.worst_iou),
                            iou_text(summary.mean_iou), ratio_text(summary.mean_ratio),
                            milliseconds_text(summary.median_milliseconds)});
    }
  }
  fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
