// Correctness and size of extracted trees: shipped models, random models, and defective inputs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "quality/parts.hpp"
#include "run_main.hpp"

namespace cloud2csg::bench {
namespace {

struct Arguments {
  std::string part = "all";
  std::vector<std::string> settings;
  std::size_t models = 0;  ///< 0: the defaults
  QualityOptions options;
};

void add_options(CLI::App& app, Arguments& arguments) {
  std::vector<std::string> names;
  for (const Setting& setting : all_settings()) names.push_back(setting.name);
  arguments.settings = names;
  QualityOptions& options = arguments.options;
  app.add_option("--part", arguments.part, "What to measure")
      ->check(CLI::IsMember(
          {"judge", "models", "random", "clusters", "repeats", "defects", "refine", "scans", "ablation", "all"}))
      ->capture_default_str();
  app.add_option("--strategies", arguments.settings, "Settings of the extraction, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "Runs a shipped model")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--models", arguments.models,
                 "Random models [500; 20 clusters of each size, 50 with defects, 100 scanned, 200 for the ablation]")
      ->check(CLI::PositiveNumber);
  app.add_option("--first-seed", options.first_seed, "Seed of the first random model")->capture_default_str();
  app.add_option("--noise", options.noise, "Noise of shipped and random models")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--keep", options.run.keep, "A folder for the worst of each part: truth, result and cloud");
  app.add_option("--threads", options.run.threads, "Tasks at a time, 0: one a core; only times depend on it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void print_part(const std::string& part, const QualityOptions& options) {
  const auto is_wanted = [&part](const char* name) { return part == name || part == "all"; };
  if (is_wanted("judge")) print_judge_check();
  if (is_wanted("models")) print_models(options);
  if (is_wanted("random")) print_random(options);
  if (is_wanted("clusters")) print_clusters(options);
  if (is_wanted("repeats")) print_repeats(options);
  if (is_wanted("defects")) print_defects(options);
  if (is_wanted("refine")) print_refinement(options);
  if (is_wanted("scans")) print_scans(options);
  if (is_wanted("ablation")) print_ablation(options);
}

int run(int argc, char** argv) {
  CLI::App app("Prints how right and how compact extracted trees are.");
  Arguments arguments;
  add_options(app, arguments);
  CLI11_PARSE(app, argc, argv);
  QualityOptions& options = arguments.options;
  if (arguments.models > 0) {
    options.random_models = options.cluster_models = options.defect_models = arguments.models;
    options.ablation_models = options.scan_models = arguments.models;
  }
  for (const Setting& setting : all_settings()) {
    if (std::ranges::count(arguments.settings, setting.name) > 0) options.run.settings.push_back(setting);
  }
  print_part(arguments.part, options);
  return 0;
}

}  // namespace
}  // namespace cloud2csg::bench

int main(int argc, char** argv) {
  return cloud2csg::bench::run_main(argc, argv, cloud2csg::bench::run);
}
