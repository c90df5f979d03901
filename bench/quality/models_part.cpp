#include <fmt/format.h>

#include <array>

#include "measure.hpp"
#include "quality/parts.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::array k_models{"m0", "m1", "m2", "m3"};
constexpr std::array<std::size_t, 2> k_points{10'000, 150'000};
constexpr double k_right_of_the_paper = 0.999;

std::vector<TableCell> row_of(const std::string& model, std::size_t points, const std::string& setting,
                              std::span<const Outcome> outcomes) {
  const Summary summary = summarise(outcomes, k_right_of_the_paper);
  return {model,
          static_cast<double>(points),
          setting,
          share_text(summary.right, summary),
          iou_text(summary.worst_iou),
          share_text(summary.no_larger, summary),
          ratio_text(summary.worst_ratio),
          ratio_text(summary.mean_ratio),
          milliseconds_text(summary.median_milliseconds),
          failures_text(outcomes)};
}

}  // namespace

void print_models(const QualityOptions& options) {
  Table table{.name = "models",
              .title = "Shipped models",
              .note = fmt::format("{} seeds each, each for a cloud and a search of its own; noise {}.\n{}",
                                  options.seeds, options.noise, legend(k_right_of_the_paper)),
              .columns = {"model", "points", "setting", "right", "worst IoU", "no larger", "worst ratio", "mean ratio",
                          "ms", "failures"}};
  for (const char* name : k_models) {
    const Model model = shipped_model(name);
    const auto judge = std::make_shared<const Judge>(model.primitives, *model.tree);
    for (const std::size_t points : k_points) {
      const auto make = [&](std::size_t i) {
        const std::uint64_t seed = i + 1;
        return make_task(model, sample_surface(model, {.count = points, .noise = options.noise, .seed = seed}), judge,
                         seed);
      };
      const auto outcomes = run_tasks(fmt::format("{}, {} points", name, points), options.seeds, make, options.run);
      for (std::size_t s = 0; s < outcomes.size(); ++s) {
        table.rows.push_back(row_of(name, points, options.run.settings[s].name, outcomes[s]));
      }
    }
  }
  fmt::print("{}\n", to_markdown(table));
}

}  // namespace cloud2csg::bench
