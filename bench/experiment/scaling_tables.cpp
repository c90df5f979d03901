#include "bench/experiment/scaling_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/experiment/step.hpp"

namespace cloud2csg {
namespace {

constexpr double k_megabyte = 1e6;

double number(std::size_t count) {
  return static_cast<double>(count);
}

std::vector<Quantity> durations_and_memory() {
  std::vector<Quantity> all = durations();
  all.push_back(peak_memory());
  return all;
}

bool has_runs(const ScalingResults& results, const ScalingCase& one) {
  return std::any_of(results.runs.begin(), results.runs.end(),
                     [&one](const ScalingRun& run) { return run.scaling_case == one; });
}

/// Calls visit(case) for each case of a sweep that was run.
template <typename Visit>
void for_each_case(const ScalingResults& results, Sweep sweep, const Visit& visit) {
  for (const Family family : results.options.families) {
    for (const ScalingCase& one : cases_of(results.options, sweep, family)) {
      if (has_runs(results, one)) visit(one);
    }
  }
}

std::vector<TableCell> name_cells(const ScalingCase& one) {
  const std::string clique = one.family == Family::random ? fmt::format("{}", one.clique_size) : "";
  return {std::string(to_string(one.family)), clique, number(one.primitives), number(one.points)};
}

std::vector<std::string> name_columns() {
  return {"family", "clique", "primitives", "points"};
}

Table growth_table(const ScalingResults& results, Sweep sweep) {
  Table table{.name = fmt::format("growth_{}", to_string(sweep)),
              .title = fmt::format("Growth with {}", description(results.options, sweep)),
              .note = "Milliseconds of each step; peak memory beside the cloud, megabytes.",
              .columns = name_columns()};
  for (const Quantity& quantity : durations_and_memory()) table.columns.push_back(quantity.name);
  for_each_case(results, sweep, [&](const ScalingCase& one) {
    std::vector<TableCell> row = name_cells(one);
    for (const Quantity& quantity : durations_and_memory()) row.emplace_back(measure(results, one, quantity));
    table.rows.push_back(std::move(row));
  });
  return table;
}

Table exponents_table(const ScalingResults& results) {
  Table table{.name = "exponents",
              .title = "Exponents",
              .note =
                  "Of size in time and memory, fitted over all runs of a row (least squares of the logarithms) ± "
                  "standard error. 1: as the size.",
              .columns = {"size", "family"}};
  for (const Quantity& quantity : durations_and_memory()) table.columns.push_back(quantity.name);
  for (const Sweep sweep : all_sweeps()) {
    for (const Family family : results.options.families) {
      std::vector<TableCell> row{description(results.options, sweep), std::string(to_string(family))};
      bool has_fit = false;
      for (const Quantity& quantity : durations_and_memory()) {
        const PowerLaw law = fitted(results, sweep, family, quantity);
        has_fit = has_fit || law.count > 0;
        row.emplace_back(Spread{.count = law.count, .mean = law.exponent, .deviation = law.error});
      }
      if (has_fit) table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table trees_table(const ScalingResults& results, Sweep sweep) {
  const std::vector<Quantity> quantities{
      {"partitions", [](const ScalingRun& run) { return number(run.partitions); }},
      {"true nodes", [](const ScalingRun& run) { return number(run.true_tree.size); }},
      {"nodes", [](const ScalingRun& run) { return number(run.tree.size); }},
      {"nodes / true", [](const ScalingRun& run) { return number(run.tree.size) / number(run.true_tree.size); }},
      {"wrong places, %", [](const ScalingRun& run) { return 100 * run.wrong_share; }},
      {"wrong primitives, %",
       [](const ScalingRun& run) { return 100 * number(run.wrong_primitives) / number(run.scaling_case.primitives); }}};
  Table table{.name = fmt::format("trees_{}", to_string(sweep)),
              .title = fmt::format("Trees, by {}", description(results.options, sweep)),
              .note =
                  "Wrong: in one of tree and truth only, of places around all primitives; primitives around which a "
                  "tenth of the places is.",
              .columns = name_columns()};
  for (const Quantity& quantity : quantities) table.columns.push_back(quantity.name);
  for_each_case(results, sweep, [&](const ScalingCase& one) {
    std::vector<TableCell> row = name_cells(one);
    for (const Quantity& quantity : quantities) row.emplace_back(measure(results, one, quantity));
    table.rows.push_back(std::move(row));
  });
  return table;
}

Table threads_table(const ScalingResults& results) {
  const int threads = results.options.threads;
  Table table{
      .name = "threads",
      .title = "Threads",
      .note = "The largest of each family; milliseconds of the extraction.",
      .columns = {"family", "primitives", "points", "1 thread", fmt::format("{} threads", threads), "speed-up"}};
  for (const Family family : results.options.families) {
    const std::vector<ScalingCase> cases = thread_cases(results.options, family);
    if (cases.size() < 2) continue;
    const Spread one = measure(results, cases.front(), extraction_milliseconds());
    const Spread all = measure(results, cases.back(), extraction_milliseconds());
    if (one.count == 0 || all.count == 0) continue;
    table.rows.push_back({std::string(to_string(family)), number(cases.front().primitives),
                          number(cases.front().points), one, all, ratio(one, all)});
  }
  return table;
}

}  // namespace

std::vector<Quantity> durations() {
  std::vector<Quantity> all;
  for (const Step& step : extraction_steps()) {
    all.push_back({std::string(step.name),
                   [seconds = step.seconds](const ScalingRun& run) { return 1e3 * run.seconds.*seconds; }});
  }
  all.push_back(extraction_milliseconds());
  return all;
}

Quantity extraction_milliseconds() {
  return {"extraction", [](const ScalingRun& run) { return 1e3 * run.seconds.extraction; }};
}

Quantity peak_memory() {
  return {"memory", [](const ScalingRun& run) { return number(run.peak_bytes) / k_megabyte; }};
}

Spread measure(const ScalingResults& results, const ScalingCase& scaling_case, const Quantity& quantity) {
  std::vector<double> values;
  for (const ScalingRun& run : results.runs) {
    if (run.scaling_case == scaling_case && run.complete) values.push_back(quantity.value(run));
  }
  return spread_of(values);
}

PowerLaw fitted(const ScalingResults& results, Sweep sweep, Family family, const Quantity& quantity) {
  const std::vector<ScalingCase> cases = cases_of(results.options, sweep, family);
  std::vector<std::pair<double, double>> pairs;
  for (const ScalingRun& run : results.runs) {
    if (!run.complete || std::find(cases.begin(), cases.end(), run.scaling_case) == cases.end()) continue;
    pairs.emplace_back(size_in(sweep, run.scaling_case), quantity.value(run));
  }
  return fit_power_law(pairs);
}

std::string description(const ScalingOptions& options, Sweep sweep) {
  switch (sweep) {
    case Sweep::primitives:
      return fmt::format("primitives, {} points each", options.points_per_primitive);
    case Sweep::primitives_at_points:
      return fmt::format("primitives, {} points in all", options.at_points);
    case Sweep::points:
      return fmt::format("points, {} primitives", options.at_primitives);
    case Sweep::cliques:
      return fmt::format("size of cliques, {} primitives, {} points", options.at_primitives, options.at_points);
  }
  return "";
}

std::vector<Table> scaling_tables(const ScalingResults& results) {
  std::vector<Table> tables{exponents_table(results)};
  for (const Sweep sweep : all_sweeps()) tables.push_back(growth_table(results, sweep));
  tables.push_back(threads_table(results));
  for (const Sweep sweep : all_sweeps()) tables.push_back(trees_table(results, sweep));
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  return tables;
}

Table scaling_runs_table(const ScalingResults& results) {
  Table table{.name = "runs",
              .title = "Runs",
              .columns = {"family", "clique", "primitives", "points", "threads", "seed", "finished", "complete",
                          "partitions", "components", "generations", "evaluations", "nodes", "depth", "true nodes",
                          "peak bytes", "cloud bytes", "wrong share", "wrong primitives"}};
  for (const Quantity& quantity : durations()) table.columns.push_back(quantity.name + " ms");
  for (const ScalingRun& run : results.runs) {
    std::vector<TableCell> row = name_cells(run.scaling_case);
    row.insert(row.end(), {fmt::format("{}", run.scaling_case.threads), fmt::format("{}", run.seed), run.finished,
                           std::string(run.complete ? "yes" : "no")});
    for (const std::size_t count : {run.partitions, run.components, run.generations, run.evaluations, run.tree.size,
                                    run.tree.depth, run.true_tree.size, run.peak_bytes, run.cloud_bytes}) {
      row.emplace_back(number(count));
    }
    row.insert(row.end(), {run.wrong_share, number(run.wrong_primitives)});
    for (const Quantity& quantity : durations()) row.emplace_back(quantity.value(run));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace cloud2csg
