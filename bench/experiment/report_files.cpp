#include "bench/experiment/report_files.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "bench/experiment/gnuplot.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

/// Draws existing scripts. Returns false without gnuplot.
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

std::string to_markdown(const TableReport& report, bool has_pictures) {
  std::string text = report.introduction;
  for (const Table& table : report.tables) text += '\n' + to_markdown(table);
  if (!has_pictures) return text;
  text += "\n## Figures\n\n";
  for (const Figure& figure : report.figures) text += fmt::format("![{0}]({0}.svg)\n", figure.name);
  return text;
}

std::vector<std::string> write_report(const std::filesystem::path& folder, const TableReport& report) {
  for (const Figure& figure : report.figures) write_text_file(folder / (figure.name + ".gp"), figure.script);
  OutputSet pictures;
  const bool has_pictures = add_pictures(pictures, folder, report.figures);

  OutputSet texts;
  for (const std::vector<Table>* tables : {&report.tables, &report.details}) {
    for (const Table& table : *tables) add_text(texts, folder / (table.name + ".csv"), to_csv(table));
  }
  add_text(texts, folder / (report.name + ".md"), to_markdown(report, has_pictures));
  texts.commit();
  if (has_pictures) {
    pictures.commit();
    return {};
  }
  return {"gnuplot is not installed: no .svg figures; their scripts are the .gp files (Debian: gnuplot-nox)"};
}

std::string describe(const Environment& environment) {
  return fmt::format("cloud2csg {}, {}; {}, {} cores", environment.version, environment.compiler, environment.cpu,
                     environment.cores);
}

std::string now_utc() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace cloud2csg
