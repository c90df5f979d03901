#include <fmt/format.h>

#include "quality/defects.hpp"
#include "quality/parts.hpp"
#include "quality/random_model.hpp"

namespace cloud2csg::bench {
namespace {

/// The strategy by cells, and variants with one change each.
std::vector<Setting> ablations() {
  std::vector<Setting> settings{{"all of it", {.strategy = Strategy::cells}}};
  const auto add = [&settings](const char* name, auto&& change) {
    Setting setting{name, {.strategy = Strategy::cells}};
    change(setting.options);
    settings.push_back(setting);
  };
  add("no evidence of absence", [](ExtractOptions& o) { o.cell_labels.absence = 0; });
  add("absence counts twice", [](ExtractOptions& o) { o.cell_labels.absence *= 2; });
  add("any point counts once", [](ExtractOptions& o) { o.cell_labels.presence = 1; });
  add("16 samples a primitive", [](ExtractOptions& o) { o.cell_samples = {.base = 16, .a_neighbour = 0}; });
  add("a quarter of the samples", [](ExtractOptions& o) { o.cell_samples = {.base = 12, .a_neighbour = 10}; });
  add("half of the samples", [](ExtractOptions& o) { o.cell_samples = {.base = 24, .a_neighbour = 20, .most = 512}; });
  add("four times the samples",
      [](ExtractOptions& o) { o.cell_samples = {.base = 192, .a_neighbour = 160, .most = 4096}; });
  add("all labels are sure", [](ExtractOptions& o) { o.cell_solve.least_evidence = {0}; });
  add("sure from 3 points on", [](ExtractOptions& o) { o.cell_solve.least_evidence = {3}; });
  add("sure from 12 points on", [](ExtractOptions& o) { o.cell_solve.least_evidence = {12}; });
  add("leaves cost nothing", [](ExtractOptions& o) { o.cell_solve.leaf_cost = 0; });
  add("leaves cost 12 points", [](ExtractOptions& o) { o.cell_solve.leaf_cost = 12; });
  add("no minimal formulas", [](ExtractOptions& o) { o.cell_solve.minimal.combination_limit = 0; });
  add("no climbing", [](ExtractOptions& o) { o.cell_solve.climb.work_limit = 0; });
  settings.push_back({"partitions instead", {.cell_trust = 2}});
  return settings;
}

std::vector<TableCell> row_of(const std::string& name, std::span<const Outcome> whole,
                              std::span<const Outcome> with_holes) {
  const Summary summary = summarise(whole, k_right);
  const Summary holes = summarise(with_holes, k_right);
  return {name,
          share_text(summary.right, summary),
          share_text(summary.no_larger, summary),
          iou_text(summary.worst_iou),
          ratio_text(summary.mean_ratio),
          milliseconds_text(summary.median_milliseconds),
          share_text(holes.right, holes),
          share_text(holes.no_larger, holes)};
}

}  // namespace

void print_ablation(const QualityOptions& options) {
  RunOptions run = options.run;
  run.settings = ablations();
  const auto outcomes_with = [&](Defect defect) {
    const auto make = [&](std::size_t i) {
      const std::uint64_t seed = options.first_seed + i;
      const RandomModel drawn = draw_model(Family::random, seed);
      return make_defective_task(
          make_model(drawn), defect,
          {.points = k_points_per_primitive * drawn.options.primitives, .noise = options.noise, .seed = seed});
    };
    return run_tasks(fmt::format("ablation, {}", to_string(defect)), options.ablation_models, make, run);
  };
  const auto whole = outcomes_with(Defect::none);
  const auto with_holes = outcomes_with(Defect::patches);
  Table table{.name = "ablation",
              .title = "The strategy by cells, part by part",
              .note = fmt::format("{} models of family random, {} points a primitive, noise {}; with holes: a fifth of "
                                  "the points is missing in patches.\n{}",
                                  options.ablation_models, k_points_per_primitive, options.noise, legend(k_right)),
              .columns = {"setting", "right", "no larger", "worst IoU", "mean ratio", "ms", "right with holes",
                          "no larger with holes"}};
  for (std::size_t s = 0; s < run.settings.size(); ++s) {
    table.rows.push_back(row_of(run.settings[s].name, whole[s], with_holes[s]));
  }
  fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
