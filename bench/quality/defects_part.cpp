#include <fmt/format.h>

#include <algorithm>

#include "measure.hpp"
#include "quality/defects.hpp"
#include "quality/parts.hpp"
#include "quality/random_model.hpp"

namespace cloud2csg::bench {
namespace {

struct KnownModel {
  Model model;
  DefectOptions options;
};

std::vector<KnownModel> known_models(const QualityOptions& options) {
  std::vector<KnownModel> models;
  for (const char* name : {"m0", "m1", "m2", "m3"}) models.push_back({shipped_model(name), {}});
  for (std::size_t i = 0; i < options.defect_models; ++i) {
    const std::uint64_t seed = options.first_seed + i;
    const RandomModel drawn = draw_model(Family::random, seed);
    models.push_back(
        {make_model(drawn),
         {.points = k_points_per_primitive * drawn.options.primitives, .noise = options.noise, .seed = seed}});
  }
  return models;
}

std::vector<TableCell> row_of(Defect defect, std::span<const Outcome> outcomes, double iou_given) {
  const Summary summary = summarise(outcomes, k_right);
  return {std::string(to_string(defect)),
          share_text(summary.right, summary),
          share_text(summary.no_larger, summary),
          iou_text(summary.worst_iou),
          iou_text(summary.mean_iou),
          iou_text(iou_given),
          ratio_text(summary.mean_ratio),
          ratio_text(summary.worst_ratio),
          milliseconds_text(summary.median_milliseconds),
          failures_text(outcomes)};
}

Table table_for(const Setting& setting, const QualityOptions& options) {
  return {.name = "defects",
          .title = fmt::format("Defects, {}", setting.name),
          .note = fmt::format("M0 to M3 with {} points, {} models of family random with {} a primitive; noise {} but "
                              "for the second row.\ntruth: mean IoU of the true tree less the missing primitive.\n{}",
                              DefectOptions{}.points, options.defect_models, k_points_per_primitive, options.noise,
                              legend(k_right)),
          .columns = {"defect", "right", "no larger", "worst IoU", "mean IoU", "truth", "mean ratio", "worst ratio",
                      "ms", "failures"}};
}

}  // namespace

void print_defects(const QualityOptions& options) {
  const std::vector<KnownModel> models = known_models(options);
  std::vector<Table> tables;
  for (const Setting& setting : options.run.settings) tables.push_back(table_for(setting, options));
  for (const Defect defect : k_defects) {
    std::vector<double> iou_given(models.size());
    const auto make = [&](std::size_t i) {
      Task task = make_defective_task(models[i].model, defect, models[i].options);
      iou_given[i] = iou_of_given(models[i].model, task);
      return task;
    };
    const auto outcomes = run_tasks(std::string(to_string(defect)), models.size(), make, options.run);
    double mean_given = 0;
    for (const double iou : iou_given) mean_given += iou / static_cast<double>(models.size());
    for (std::size_t s = 0; s < tables.size(); ++s) {
      tables[s].rows.push_back(row_of(defect, outcomes[s], mean_given));
    }
  }
  for (const Table& table : tables) fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
