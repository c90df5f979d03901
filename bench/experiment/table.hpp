#pragma once

#include <string>
#include <variant>
#include <vector>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {

/// A text, a number, or a mean with its deviation.
using TableCell = std::variant<std::string, double, Spread>;

struct Table {
  std::string name;  ///< of its file, without the ending
  std::string title;
  std::string note = {};  ///< what is measured, in which unit, where the title does not say it all
  std::vector<std::string> columns;
  std::vector<std::vector<TableCell>> rows = {};  ///< each with a cell a column
};

/// Four digits that count, no exponent; of a deviation two, and its mean has as many decimals: "12.346 ± 0.057". That
/// of a single value is "?".
[[nodiscard]] std::string to_text(const TableCell& cell);

/// A heading, the note, the columns padded to equal widths.
[[nodiscard]] std::string to_markdown(const Table& table);

/// A column with spreads becomes two, NAME and "NAME sd"; full precision. Texts with a comma or a quote are quoted.
[[nodiscard]] std::string to_csv(const Table& table);

}  // namespace cloud2csg
