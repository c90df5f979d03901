#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/report_files.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "paper/paper_method.hpp"

namespace cloud2csg {
namespace {

ExtractOptions extract_options(const PaperOptions& options, const PaperMode& mode, std::uint64_t seed) {
  ExtractOptions extract = options.preset == PaperPreset::paper ? paper_options() : ExtractOptions{};
  extract.strategy = mode.strategy;
  extract.parallel = mode.parallel;
  extract.seed = seed;
  return extract;
}

PaperRun measured(const RunName& name, const Extraction& extraction) {
  const ExtractStatistics& statistics = extraction.statistics;
  PaperRun run{.name = name,
               .finished = now_utc(),
               .points = statistics.points,
               .clique_histogram = statistics.clique_histogram,
               .seconds = statistics.seconds,
               .tree = statistics.tree,
               .formula = to_text(extraction.tree(), extraction.model.primitives),
               .fit = statistics.fit,
               .generations = statistics.merge.generations,
               .evaluations = statistics.merge.evaluations,
               .blocked = statistics.merge.blocked};
  for (const PartitionStatistics& partition : statistics.partitions) {
    run.generations += partition.generations;
    run.evaluations += partition.evaluations;
  }
  for (const MergeWay way : statistics.merge.ways) run.merge_ways.emplace_back(to_string(way));
  return run;
}

class CloudRuns {
 public:
  CloudRuns(const Model& model, const PaperOptions& options, Sampling sampling, const RunContext& run)
      : model_(model),
        options_(options),
        run_{.stop = run.stop, .on_progress = {}, .threads = options.threads},
        cloud_(sample_surface(model,
                              {.count = sampling == Sampling::low ? options.low_points : options.high_points,
                               .noise = options.noise,
                               .seed = options.seed},
                              run_)) {
    // An unmeasured run starts the threads and gets memory from the system. The slow reference is not worth it.
    if (options.evaluator == PaperEvaluator::classes) (void)extraction(paper_mode("SMTPGA"), options.seed);
  }

  [[nodiscard]] PaperRun make(const RunName& name) const {
    return measured(name, extraction(paper_mode(name.mode), name.seed));
  }

 private:
  [[nodiscard]] Extraction extraction(const PaperMode& mode, std::uint64_t seed) const {
    const ExtractOptions extract = extract_options(options_, mode, seed);
    Extraction result = options_.evaluator == PaperEvaluator::reference
                            ? extract_as_in_paper(cloud_, model_.primitives, extract, run_)
                            : extract_csg(cloud_, model_.primitives, extract, run_);
    // The mode gives no result when stopped early.
    if (!result.statistics.complete) throw Cancelled();
    return result;
  }

  const Model& model_;
  const PaperOptions& options_;
  RunContext run_;
  PointCloud cloud_;
};

bool has_run(const PaperResults& results, const RunName& name) {
  return std::any_of(results.runs.begin(), results.runs.end(),
                     [&name](const PaperRun& run) { return run.name == name; });
}

bool shares_cloud(const RunName& a, const RunName& b) {
  return a.model == b.model && a.sampling == b.sampling;
}

}  // namespace

void run_paper(std::span<const Model> models, PaperResults& results, const std::function<void()>& on_finished,
               const RunContext& run) {
  const PaperOptions& options = results.options;
  validate(options);
  assert(models.size() == options.models.size());
  const std::vector<RunName> plan = plan_runs(options);
  const std::size_t runs_per_cloud = options.repeats * paper_modes().size();
  std::optional<CloudRuns> cloud_runs;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    run.throw_if_stopped();
    const RunName& name = plan[i];
    if (i > 0 && !shares_cloud(plan[i - 1], name)) cloud_runs.reset();
    if (has_run(results, name)) continue;
    const std::string stage =
        fmt::format("{} {} {}/{}", name.model, to_string(name.sampling), i / runs_per_cloud + 1, 2 * models.size());
    run.report(stage, i % runs_per_cloud, runs_per_cloud, "runs");
    if (!cloud_runs) cloud_runs.emplace(models[i / (2 * runs_per_cloud)], options, name.sampling, run);
    results.runs.push_back(cloud_runs->make(name));
    on_finished();
    run.report(stage, i % runs_per_cloud + 1, runs_per_cloud, "runs");
  }
}

}  // namespace cloud2csg
