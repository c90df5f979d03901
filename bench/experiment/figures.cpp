#include "bench/experiment/figures.hpp"

#include <fmt/format.h>

#include <functional>
#include <string_view>

#include "bench/experiment/paper_tables.hpp"

namespace cloud2csg {
namespace {

constexpr std::string_view k_bars =
    R"(set style data histogram
set style fill solid 0.85 border -1
set boxwidth 0.9
)";

struct Series {
  std::string title;
  std::function<Spread(const ModelDetails&)> value;
};

/// The data of a figure: one line per model, two columns per series. Missing values do not appear.
std::string data_block(const PaperResults& results, const std::vector<Series>& series) {
  std::string text = "$data << END\nmodel";
  for (const Series& one : series) text += fmt::format(" {} sd", in_gnuplot_quotes(one.title));
  for (const ModelDetails& model : results.models) {
    text += fmt::format("\n{}", in_gnuplot_quotes(model.name));
    for (const Series& one : series) {
      const Spread spread = one.value(model);
      text += spread.count == 0 ? std::string(" ? ?") : fmt::format(" {} {}", spread.mean, spread.deviation);
    }
  }
  return text + "\nEND\n";
}

/// Adjacent bars with deviations, one group per model.
std::string grouped_bars(const PaperResults& results, std::string_view title, std::string_view unit, bool is_log,
                         const std::vector<Series>& series) {
  return fmt::format(
      "{}{}set style histogram errorbars gap 1.5 linewidth 1\nset title {}\nset ylabel {}\n{}{}"
      "plot for [i=2:{}:2] $data using (column(i)):(column(i + 1)):xtic(1) title columnheader(i)\n",
      k_figure_style, k_bars, in_gnuplot_quotes(title), in_gnuplot_quotes(unit),
      is_log ? "set logscale y\n" : "set yrange [0:*]\n", data_block(results, series), 2 * series.size());
}

/// Stacked bars, one per model.
std::string stacked_bars(const PaperResults& results, std::string_view title, std::string_view unit,
                         const std::vector<Series>& series) {
  return fmt::format(
      "{}{}set style histogram rowstacked\nset boxwidth 0.6\nset title {}\nset ylabel {}\nset yrange [0:*]\n{}"
      "plot for [i=2:{}:2] $data using (column(i)):xtic(1) title columnheader(i)\n",
      k_figure_style, k_bars, in_gnuplot_quotes(title), in_gnuplot_quotes(unit), data_block(results, series),
      2 * series.size());
}

Figure durations_figure(const PaperResults& results, Sampling sampling) {
  std::vector<Series> series;
  for (const PaperMode& mode : paper_modes()) {
    series.push_back({std::string(mode.name), [&results, sampling, &mode](const ModelDetails& model) {
                        return measure(results, model.name, sampling, mode.name, milliseconds);
                      }});
  }
  const std::size_t points = sampling == Sampling::low ? results.options.low_points : results.options.high_points;
  return {.name = fmt::format("durations_{}", to_string(sampling)),
          .script = grouped_bars(results, fmt::format("Extraction, {} points", points), "milliseconds", true, series)};
}

Figure trees_figure(const PaperResults& results) {
  const auto size_of = [&results](std::string_view mode) {
    return [&results, mode](const ModelDetails& model) {
      return measure(results, model.name, Sampling::high, mode,
                     [](const PaperRun& run) { return static_cast<double>(run.tree.size); });
    };
  };
  const auto input = [](const ModelDetails& model) {
    return Spread{.count = 1, .mean = static_cast<double>(model.tree.size)};
  };
  return {.name = "tree_sizes",
          .script =
              grouped_bars(results, fmt::format("Nodes of the trees, {} points", results.options.high_points), "nodes",
                           false, {{"input", input}, {"baseline", size_of("BST")}, {"partitioned", size_of("SST")}})};
}

Figure steps_figure(const PaperResults& results) {
  std::vector<Series> series;
  for (const Step& step : extraction_steps()) {
    series.push_back({std::string(step.name), [&results, &step](const ModelDetails& model) {
                        return measure(results, model.name, Sampling::high, "SST", share_of(step));
                      }});
  }
  return {.name = "steps",
          .script = stacked_bars(results, fmt::format("Steps of SST, {} points", results.options.high_points),
                                 "percent", series)};
}

}  // namespace

std::vector<Figure> paper_figures(const PaperResults& results) {
  return {durations_figure(results, Sampling::low), durations_figure(results, Sampling::high), trees_figure(results),
          steps_figure(results)};
}

}  // namespace cloud2csg
