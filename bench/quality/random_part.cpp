#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "cloud2csg/sample.hpp"
#include "quality/parts.hpp"
#include "quality/random_model.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_worst = 10;

/// The models of a table, with the density of their clouds.
struct RandomModels {
  std::string name, title;
  std::vector<RandomModel> models = {};
  std::size_t points_per_primitive = k_points_per_primitive;
};

Task make_random_task(const RandomModel& random_model, std::size_t points_per_primitive, double noise) {
  const Model model = make_model(random_model);
  const std::uint64_t seed = random_model.options.seed;
  PointCloud cloud =
      sample_surface(model, {.count = points_per_primitive * model.primitives.size(), .noise = noise, .seed = seed});
  return make_task(model, std::move(cloud), std::make_shared<Judge>(model.primitives, *model.tree), seed);
}

/// Row order in the table: families in declaration order, cliques by size.
using Kind = std::pair<Family, std::size_t>;

Kind kind(const RandomModel& model) {
  return {model.family, model.family == Family::random ? model.options.clique_size : 0};
}

std::vector<TableCell> row_of(const std::string& name, std::span<const Outcome> outcomes) {
  const Summary summary = summarise(outcomes, k_right);
  return {name,
          share_text(summary.right, summary),
          share_text(summary.no_larger, summary),
          share_text(summary.right_and_no_larger, summary),
          share_text(summary.proved, summary),
          share_text(summary.no_deeper, summary),
          iou_text(summary.worst_iou),
          ratio_text(summary.mean_ratio),
          milliseconds_text(summary.median_milliseconds),
          failures_text(outcomes)};
}

Table table_of(const Setting& setting, const RandomModels& of, std::span<const Outcome> outcomes, double noise) {
  const std::vector<RandomModel>& models = of.models;
  Table table{
      .name = of.name,
      .title = fmt::format("{}, {}", of.title, setting.name),
      .note = fmt::format("{} points a primitive, noise {}.\n{}", of.points_per_primitive, noise, legend(k_right)),
      .columns = {"models", "right", "no larger", "both", "proved", "no deeper", "worst IoU", "mean ratio", "ms",
                  "failures"}};
  std::set<Kind> kinds;
  for (const RandomModel& model : models) kinds.insert(kind(model));
  for (const Kind& one : kinds) {
    std::string name;
    std::vector<Outcome> members;
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (kind(models[i]) != one) continue;
      name = kind_of(models[i]);
      members.push_back(outcomes[i]);
    }
    table.rows.push_back(row_of(name, members));
  }
  table.rows.push_back(row_of("all", outcomes));
  return table;
}

/// Wrong models first, worst first; then models larger than the truth, largest first.
Table worst_models(const Setting& setting, std::span<const RandomModel> models, std::span<const Outcome> outcomes) {
  Table table{.name = "worst",
              .title = fmt::format("Worst models, {}", setting.name),
              .note = "Of those that are wrong or larger than the truth. The seed is that of cloud and search as well.",
              .columns = {"IoU", "ratio", "model", "failure"}};
  std::vector<std::size_t> order(models.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::erase_if(order, [&](std::size_t i) { return outcomes[i].iou >= k_right && outcomes[i].size_ratio <= 1; });
  const auto badness = [&](std::size_t i) {
    return std::tuple(outcomes[i].iou < k_right ? outcomes[i].iou : 1, -outcomes[i].size_ratio, i);
  };
  std::ranges::sort(order, {}, badness);
  if (order.size() > k_worst) order.resize(k_worst);
  for (const std::size_t i : order) {
    table.rows.push_back(
        {iou_text(outcomes[i].iou), ratio_text(outcomes[i].size_ratio), source_of(models[i]), outcomes[i].failure});
  }
  return table;
}

void print_models_of(const RandomModels& of, const QualityOptions& options) {
  const auto make = [&](std::size_t i) {
    return make_random_task(of.models[i], of.points_per_primitive, options.noise);
  };
  const auto outcomes = run_tasks(of.name, of.models.size(), make, options.run);
  for (std::size_t s = 0; s < outcomes.size(); ++s) {
    const Setting& setting = options.run.settings[s];
    fmt::print("{}\n", to_markdown(table_of(setting, of, outcomes[s], options.noise)));
    const Table worst = worst_models(setting, of.models, outcomes[s]);
    if (!worst.rows.empty()) fmt::print("{}\n", to_markdown(worst));
  }
}

}  // namespace

void print_random(const QualityOptions& options) {
  RandomModels random{.name = "random models", .title = "Random models"};
  for (std::size_t i = 0; i < options.random_models; ++i) {
    const std::uint64_t seed = options.first_seed + i;
    random.models.push_back(draw_model(family_of_seed(seed), seed));
  }
  print_models_of(random, options);
}

void print_clusters(const QualityOptions& options) {
  // With 400 points per primitive, most pieces of the surface have none.
  RandomModels clusters{.name = "clusters", .title = "Clusters", .points_per_primitive = 1000};
  for (const std::size_t size : {12U, 16U, 20U}) {
    for (std::size_t i = 0; i < options.cluster_models; ++i) {
      const FamilyOptions family{.primitives = size, .clique_size = size, .seed = options.first_seed + i};
      clusters.models.push_back({.family = Family::random, .options = family});
    }
  }
  print_models_of(clusters, options);
}

void print_repeats(const QualityOptions& options) {
  RandomModels repeating{.name = "repeats", .title = "Primitives used again", .points_per_primitive = 1000};
  for (std::size_t i = 0; i < options.cluster_models; ++i) {
    constexpr std::size_t k_primitives = 12;
    const FamilyOptions family{.primitives = k_primitives, .clique_size = k_primitives, .seed = options.first_seed + i};
    repeating.models.push_back({.family = Family::random, .options = family, .repeats = k_primitives / 2});
  }
  print_models_of(repeating, options);
}

}  // namespace cloud2csg::bench
