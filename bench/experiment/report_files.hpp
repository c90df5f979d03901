#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/experiment/figure.hpp"
#include "bench/experiment/table.hpp"

namespace cloud2csg {

struct TableReport {
  std::string name;            ///< name of the .md file without the ending
  std::string introduction;    ///< heading and setting
  std::vector<Table> tables;   ///< in the .md file and as .csv
  std::vector<Table> details;  ///< as .csv only
  std::vector<Figure> figures;
};

/// The text of the .md file, with figures if `has_pictures`.
[[nodiscard]] std::string to_markdown(const TableReport& report, bool has_pictures);

/// Writes NAME.md, a .csv per table, and a .gp script and (by gnuplot) an .svg per figure. Returns notes on missing
/// files: without gnuplot there are no .svg. @throws Error
[[nodiscard]] std::vector<std::string> write_report(const std::filesystem::path& folder, const TableReport& report);

/// "cloud2csg 1.2.3, g++ 12; Some CPU, 2 cores"
[[nodiscard]] std::string describe(const Environment& environment);

/// Date and time, UTC, ISO 8601.
[[nodiscard]] std::string now_utc();

}  // namespace cloud2csg
