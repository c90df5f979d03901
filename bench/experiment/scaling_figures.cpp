#include "bench/experiment/scaling_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "bench/experiment/scaling_tables.hpp"

namespace cloud2csg {
namespace {

/// A line of a figure: its title and its points in gnuplot's format.
struct Line {
  std::string title;
  std::string points;
  std::size_t count = 0;
};

/// "size mean low high" per case. A low value of zero or less has no logarithm and is clamped.
Line line_of(const ScalingResults& results, Sweep sweep, Family family, const Quantity& quantity) {
  Line line;
  for (const ScalingCase& one : cases_of(results.options, sweep, family)) {
    const Spread spread = measure(results, one, quantity);
    if (spread.count == 0 || spread.mean <= 0) continue;
    constexpr double k_lowest = 0.1;
    const double low = std::max(spread.mean - spread.deviation, k_lowest * spread.mean);
    line.points += fmt::format("{} {} {} {}\n", size_in(sweep, one), spread.mean, low, spread.mean + spread.deviation);
    ++line.count;
  }
  return line;
}

/// The title followed by the fitted exponent.
std::string with_exponent(const std::string& title, const PowerLaw& law) {
  return law.count == 0 ? title : fmt::format("{} ~ n^{:.2f}", title, law.exponent);
}

std::string log_log_script(std::string_view title, std::string_view size, std::string_view value,
                           const std::vector<Line>& lines) {
  std::string script(k_figure_style);
  script += fmt::format("set grid xtics\nset logscale xy\nset title {}\nset xlabel {}\nset ylabel {}\n",
                        in_gnuplot_quotes(title), in_gnuplot_quotes(size), in_gnuplot_quotes(value));
  std::string plot;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    script += fmt::format("$line{} << END\n{}END\n", i, lines[i].points);
    plot += fmt::format("{} $line{} using 1:2:3:4 with yerrorlines pointtype 7 pointsize 0.5 title {}",
                        i == 0 ? "plot" : ",", i, in_gnuplot_quotes(lines[i].title));
  }
  return script + plot + '\n';
}

std::string size_label(Sweep sweep) {
  return sweep == Sweep::points ? "points" : sweep == Sweep::cliques ? "primitives of a clique" : "primitives";
}

/// Adds a figure of the non-empty lines, if there are any.
void add_figure(std::vector<Figure>& figures, const std::string& name, const std::string& title, Sweep sweep,
                std::string_view value, std::vector<Line> lines) {
  std::erase_if(lines, [](const Line& line) { return line.count == 0; });
  if (lines.empty()) return;
  figures.push_back({.name = name, .script = log_log_script(title, size_label(sweep), value, lines)});
}

std::vector<Line> lines_by_family(const ScalingResults& results, Sweep sweep, const Quantity& quantity) {
  std::vector<Line> lines;
  for (const Family family : results.options.families) {
    lines.push_back(line_of(results, sweep, family, quantity));
    lines.back().title = with_exponent(std::string(to_string(family)), fitted(results, sweep, family, quantity));
  }
  return lines;
}

std::vector<Line> lines_by_step(const ScalingResults& results, Sweep sweep, Family family) {
  std::vector<Line> lines;
  for (const Quantity& quantity : durations()) {
    lines.push_back(line_of(results, sweep, family, quantity));
    lines.back().title = with_exponent(quantity.name, fitted(results, sweep, family, quantity));
  }
  return lines;
}

}  // namespace

std::vector<Figure> scaling_figures(const ScalingResults& results) {
  std::vector<Figure> figures;
  for (const Sweep sweep : all_sweeps()) {
    const std::string varied = description(results.options, sweep);
    add_figure(figures, fmt::format("time_{}", to_string(sweep)), fmt::format("Extraction by {}", varied), sweep,
               "milliseconds", lines_by_family(results, sweep, extraction_milliseconds()));
    add_figure(figures, fmt::format("memory_{}", to_string(sweep)), fmt::format("Peak memory by {}", varied), sweep,
               "megabytes beside the cloud", lines_by_family(results, sweep, peak_memory()));
  }
  for (const Family family : results.options.families) {
    for (const Sweep sweep : {Sweep::primitives, Sweep::points}) {
      add_figure(figures, fmt::format("steps_{}_{}", to_string(family), to_string(sweep)),
                 fmt::format("Steps, {}, by {}", to_string(family), description(results.options, sweep)), sweep,
                 "milliseconds", lines_by_step(results, sweep, family));
    }
  }
  return figures;
}

}  // namespace cloud2csg
