#include "bench/experiment/paper_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace cloud2csg {
namespace {

constexpr std::array k_samplings{Sampling::low, Sampling::high};
constexpr std::array<std::string_view, 2> k_single_threaded{"BST", "SST"};

double tree_size(const PaperRun& run) {
  return static_cast<double>(run.tree.size);
}
double tree_depth(const PaperRun& run) {
  return static_cast<double>(run.tree.depth);
}

double search_milliseconds(const PaperRun& run) {
  return 1e3 * (run.seconds.search + run.seconds.merge);
}

/// By how much a exceeds b, in percent.
Spread percent_larger(const Spread& a, const Spread& b) {
  if (a.count == 0 || b.count == 0) return {};
  const Spread quotient = ratio(a, b);
  return {.count = quotient.count, .mean = 100 * quotient.mean - 100, .deviation = 100 * quotient.deviation};
}

Spread ratio_if_measured(const Spread& a, const Spread& b) {
  return a.count == 0 || b.count == 0 || b.mean == 0 ? Spread{} : ratio(a, b);
}

/// A value without deviation.
Spread exactly(double value, std::size_t count) {
  return {.count = count, .mean = value, .deviation = 0};
}

/// At high sampling, since a smaller cloud may lack points on some primitive, which is then left out.
std::string cliques_of(const PaperResults& results, const std::string& model) {
  const auto run = std::find_if(results.runs.rbegin(), results.runs.rend(), [&model](const PaperRun& r) {
    return r.name.model == model && r.name.sampling == Sampling::high &&
           paper_mode(r.name.mode).strategy == Strategy::partition;
  });
  return run == results.runs.rend() ? "-" : fmt::format("({})", fmt::join(run->clique_histogram, ", "));
}

Table models_table(const PaperResults& results) {
  Table table{
      .name = "models",
      .title = "Models",
      .note = "Nodes and depth of the true tree, points of the clouds, cliques by size (1, 2, 3...) at high sampling.",
      .columns = {"model", "primitives", "nodes", "depth", "points, low", "points, high", "cliques"}};
  for (const ModelDetails& model : results.models) {
    table.rows.push_back({model.name, static_cast<double>(model.primitives), static_cast<double>(model.tree.size),
                          static_cast<double>(model.tree.depth), static_cast<double>(results.options.low_points),
                          static_cast<double>(results.options.high_points), cliques_of(results, model.name)});
  }
  return table;
}

/// A table with one row per model and sampling; `add_cells` adds cells after the two that name the row.
template <typename AddCells>
Table by_cloud(const PaperResults& results, Table table, const AddCells& add_cells) {
  table.columns.insert(table.columns.begin(), {"model", "sampling"});
  for (const ModelDetails& model : results.models) {
    for (const Sampling sampling : k_samplings) {
      std::vector<TableCell> row{model.name, std::string(to_string(sampling))};
      add_cells(row, model, sampling);
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table durations_table(const PaperResults& results) {
  Table table{.name = "durations",
              .title = "Duration of the extraction, milliseconds",
              .note = "From cloud and primitives in memory to the simplified tree.",
              .columns = {}};
  for (const PaperMode& mode : paper_modes()) table.columns.emplace_back(mode.name);
  return by_cloud(results, std::move(table),
                  [&](std::vector<TableCell>& row, const ModelDetails& model, Sampling sampling) {
                    for (const PaperMode& mode : paper_modes()) {
                      row.emplace_back(measure(results, model.name, sampling, mode.name, milliseconds));
                    }
                  });
}

Table growth_table(const PaperResults& results) {
  Table table{.name = "growth",
              .title = "Growth",
              .note =
                  "(points high / points low) : (duration high / duration low); above 1, time grows slower than the "
                  "points.",
              .columns = {"model"}};
  const double points =
      static_cast<double>(results.options.high_points) / static_cast<double>(results.options.low_points);
  for (const PaperMode& mode : paper_modes()) table.columns.emplace_back(mode.name);
  for (const ModelDetails& model : results.models) {
    std::vector<TableCell> row{model.name};
    for (const PaperMode& mode : paper_modes()) {
      const auto duration = [&](Sampling sampling) {
        return measure(results, model.name, sampling, mode.name, milliseconds);
      };
      const Spread growth = ratio_if_measured(duration(Sampling::high), duration(Sampling::low));
      row.emplace_back(ratio_if_measured(exactly(points, growth.count), growth));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Each partitioned mode against the baseline with as many threads.
Table speed_up_table(const PaperResults& results, Table table, const Measure& value) {
  table.columns = {"BST / SST", "BMTGA / SMTP", "BMTGA / SMTGA", "BMTGA / SMTPGA"};
  return by_cloud(
      results, std::move(table), [&](std::vector<TableCell>& row, const ModelDetails& model, Sampling sampling) {
        const auto of = [&](std::string_view mode) { return measure(results, model.name, sampling, mode, value); };
        row.emplace_back(ratio_if_measured(of("BST"), of("SST")));
        for (const char* mode : {"SMTP", "SMTGA", "SMTPGA"}) {
          row.emplace_back(ratio_if_measured(of("BMTGA"), of(mode)));
        }
      });
}

Table trees_table(const PaperResults& results) {
  Table table{.name = "trees",
              .title = "Trees",
              .note =
                  "Nodes and depth of the input, the baseline's and the partitioned tree; how much larger the last "
                  "is.",
              .columns = {"input", "baseline", "partitioned", "over input, %", "over baseline, %", "input depth",
                          "baseline depth", "partitioned depth"}};
  return by_cloud(
      results, std::move(table), [&](std::vector<TableCell>& row, const ModelDetails& model, Sampling sampling) {
        const Spread baseline = measure(results, model.name, sampling, "BST", tree_size);
        const Spread partitioned = measure(results, model.name, sampling, "SST", tree_size);
        const auto input = static_cast<double>(model.tree.size);
        row.insert(row.end(),
                   {input, baseline, partitioned, percent_larger(partitioned, exactly(input, partitioned.count)),
                    percent_larger(partitioned, baseline), static_cast<double>(model.tree.depth),
                    measure(results, model.name, sampling, "BST", tree_depth),
                    measure(results, model.name, sampling, "SST", tree_depth)});
      });
}

/// A table with one row per model, sampling and strategy, on one thread.
Table by_strategy(const PaperResults& results, Table table, std::span<const Measure> columns) {
  table.columns.insert(table.columns.begin(), {"model", "sampling", "mode"});
  for (const ModelDetails& model : results.models) {
    for (const Sampling sampling : k_samplings) {
      for (const std::string_view mode : k_single_threaded) {
        std::vector<TableCell> row{model.name, std::string(to_string(sampling)), std::string(mode)};
        for (const Measure& column : columns) row.emplace_back(measure(results, model.name, sampling, mode, column));
        table.rows.push_back(std::move(row));
      }
    }
  }
  return table;
}

Table search_table(const PaperResults& results) {
  const std::array<Measure, 6> columns{
      [](const PaperRun& run) { return run.fit.objective; }, [](const PaperRun& run) { return run.fit.rms_distance; },
      [](const PaperRun& run) { return run.fit.rms_angle_deg; },
      [](const PaperRun& run) { return static_cast<double>(run.generations); },
      [](const PaperRun& run) { return static_cast<double>(run.evaluations); },
      // Fall-backs. A baseline has none, since each of its components is one partition.
      [](const PaperRun& run) {
        return static_cast<double>(std::count_if(run.merge_ways.begin(), run.merge_ways.end(), [](const auto& way) {
          return way != to_string(MergeWay::single) && way != to_string(MergeWay::paper);
        }));
      }};
  return by_strategy(
      results,
      {.name = "search",
       .title = "Search",
       .note = "E of the result over all points and its fit; generations and evaluations of all searches; "
               "components whose tree came by a fall-back of the merge.",
       .columns = {"E", "rms distance", "rms angle, deg", "generations", "evaluations", "fall-backs"}},
      columns);
}

Table steps_table(const PaperResults& results) {
  Table table{
      .name = "steps", .title = "Share of each step, percent", .note = "Of the duration on one thread.", .columns = {}};
  std::vector<Measure> columns;
  for (const Step& step : extraction_steps()) {
    table.columns.emplace_back(step.name);
    columns.push_back(share_of(step));
  }
  return by_strategy(results, std::move(table), columns);
}

}  // namespace

Spread measure(const PaperResults& results, std::string_view model, Sampling sampling, std::string_view mode,
               const Measure& value) {
  std::vector<double> values;
  for (const PaperRun& run : results.runs) {
    if (run.name.model == model && run.name.sampling == sampling && run.name.mode == mode) values.push_back(value(run));
  }
  return spread_of(values);
}

double milliseconds(const PaperRun& run) {
  return 1e3 * run.seconds.extraction;
}

Measure share_of(const Step& step) {
  return [seconds = step.seconds](const PaperRun& run) { return 100 * run.seconds.*seconds / run.seconds.extraction; };
}

std::vector<Table> paper_tables(const PaperResults& results) {
  return {models_table(results),
          durations_table(results),
          speed_up_table(results,
                         {.name = "speed_up",
                          .title = "Speed-up of partitions, whole extraction",
                          .note = "Duration of the baseline / that of the partitioned mode.",
                          .columns = {}},
                         milliseconds),
          speed_up_table(results,
                         {.name = "speed_up_search",
                          .title = "Speed-up of partitions, search and merge alone",
                          .note = "The same without the pass over the points, which both share.",
                          .columns = {}},
                         search_milliseconds),
          growth_table(results),
          trees_table(results),
          search_table(results),
          steps_table(results)};
}

Table runs_table(const PaperResults& results) {
  Table table{.name = "runs",
              .title = "Runs",
              .columns = {"model", "sampling", "mode", "seed", "finished", "points", "generations", "evaluations",
                          "nodes", "leaves", "depth", "blocked", "E", "rms distance", "rms angle deg"}};
  for (const Step& step : extraction_steps()) table.columns.push_back(fmt::format("{} s", step.name));
  table.columns.emplace_back("extraction s");
  for (const PaperRun& run : results.runs) {
    std::vector<TableCell> row{run.name.model, std::string(to_string(run.name.sampling)), run.name.mode,
                               fmt::format("{}", run.name.seed), run.finished};
    for (const std::size_t count :
         {run.points, run.generations, run.evaluations, run.tree.size, run.tree.leaves, run.tree.depth, run.blocked}) {
      row.emplace_back(static_cast<double>(count));
    }
    row.insert(row.end(), {run.fit.objective, run.fit.rms_distance, run.fit.rms_angle_deg});
    for (const Step& step : extraction_steps()) row.emplace_back(run.seconds.*step.seconds);
    row.emplace_back(run.seconds.extraction);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace cloud2csg
