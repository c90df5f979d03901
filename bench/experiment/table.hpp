#pragma once

#include <string>
#include <variant>
#include <vector>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {

/// A text, a number, or a mean with its deviation.
using TableCell = std::variant<std::string, double, Spread>;

struct Table {
  std::string name;  ///< file name without the ending
  std::string title;
  std::string note = {};  ///< measured quantity and unit, beyond the title
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows = {};  ///< one cell per column
};

/// Four significant digits, no exponent; two for a deviation: "12.346 ± 0.057". A single value has deviation "?".
[[nodiscard]] std::string to_text(const TableCell& cell);

/// A heading, the note, and columns padded to equal widths.
[[nodiscard]] std::string to_markdown(const Table& table);

/// A column of spreads becomes two, NAME and "NAME sd". Full precision; texts with a comma or quote are quoted.
[[nodiscard]] std::string to_csv(const Table& table);

}  // namespace cloud2csg
