#include "experiment/paper_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/atomic_file.hpp"
#include "base/output_set.hpp"
#include "experiment/figures.hpp"
#include "experiment/gnuplot.hpp"
#include "experiment/paper_tables.hpp"

namespace cloud2csg {
namespace {

std::string setting(const PaperResults& results) {
  const PaperOptions& options = results.options;
  const Environment& machine = results.environment;
  const auto [first, last] =
      std::minmax_element(results.runs.begin(), results.runs.end(),
                          [](const PaperRun& a, const PaperRun& b) { return a.finished < b.finished; });
  return fmt::format(
      "cloud2csg {}, {}; {}, {} cores; runs from {} to {}.\n"
      "Preset {}, evaluator {}, noise {}, {} repeats with seeds {} to {} for the search, one cloud a model and "
      "sampling (seed {}).\n"
      "Parallel modes use {} threads. Mean ± standard deviation over the repeats.\n",
      machine.version, machine.compiler, machine.cpu, machine.cores, first->finished, last->finished, options.preset,
      options.evaluator, options.noise, options.repeats, options.seed, options.seed + options.repeats - 1, options.seed,
      options.threads);
}

std::string mode_check(const PaperResults& results) {
  const std::vector<std::string> disagreements = mode_disagreements(results);
  if (disagreements.empty()) {
    return fmt::format(
        "Every mode of a strategy gave the same tree for the same model, sampling and seed, in all {} runs.\n",
        results.runs.size());
  }
  return fmt::format("**Modes of the same strategy and seed gave different trees**, which must not be:\n- {}\n",
                     fmt::join(disagreements, "\n- "));
}

/// Draws these scripts, which are there already. False when there is no gnuplot.
bool add_pictures(OutputSet& pictures, const std::filesystem::path& folder, const std::vector<Figure>& figures) {
  bool is_installed = true;
  for (const Figure& figure : figures) {
    pictures.add(folder / (figure.name + ".svg"), [&](const std::filesystem::path& picture) {
      is_installed = is_installed && run_gnuplot(folder / (figure.name + ".gp"), picture);
    });
  }
  return is_installed;
}

void add_text(OutputSet& texts, const std::filesystem::path& file, const std::string& text) {
  texts.add(file, [&text](const std::filesystem::path& path) { write_text_file(path, text); });
}

}  // namespace

std::vector<std::string> mode_disagreements(const PaperResults& results) {
  const auto strategy = [](const PaperRun& run) { return paper_mode(run.name.mode).strategy; };
  std::vector<std::string> disagreements;
  for (auto run = results.runs.begin(); run != results.runs.end(); ++run) {
    const auto first = std::find_if(results.runs.begin(), run, [&](const PaperRun& other) {
      return other.name.model == run->name.model && other.name.sampling == run->name.sampling &&
             other.name.seed == run->name.seed && strategy(other) == strategy(*run);
    });
    if (first == run || first->formula == run->formula) continue;
    disagreements.push_back(fmt::format("{} {}, seed {}: {} and {}", run->name.model, to_string(run->name.sampling),
                                        run->name.seed, first->name.mode, run->name.mode));
  }
  return disagreements;
}

std::string paper_markdown(const PaperResults& results, bool has_pictures) {
  std::string text = "# The paper's evaluation\n\n" + setting(results) + '\n' + mode_check(results);
  for (const Table& table : paper_tables(results)) text += '\n' + to_markdown(table);
  if (!has_pictures) return text;
  text += "\n## Figures\n\n";
  for (const Figure& figure : paper_figures(results)) text += fmt::format("![{0}]({0}.svg)\n", figure.name);
  return text;
}

std::vector<std::string> write_paper_report(const std::filesystem::path& folder, const PaperResults& results) {
  const std::vector<Figure> figures = paper_figures(results);
  for (const Figure& figure : figures) write_text_file(folder / (figure.name + ".gp"), figure.script);
  OutputSet pictures;
  const bool has_pictures = add_pictures(pictures, folder, figures);

  OutputSet texts;
  for (const Table& table : paper_tables(results)) add_text(texts, folder / (table.name + ".csv"), to_csv(table));
  add_text(texts, folder / "runs.csv", to_csv(runs_table(results)));
  add_text(texts, folder / "paper.md", paper_markdown(results, has_pictures));
  texts.commit();
  if (has_pictures) {
    pictures.commit();
    return {};
  }
  return {"gnuplot is not installed: no .svg figures; their scripts are the .gp files (Debian: gnuplot-nox)"};
}

}  // namespace cloud2csg
