#include "bench/experiment/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

constexpr int k_digits = 4;            ///< significant digits
constexpr int k_deviation_digits = 2;  ///< significant digits of a deviation; the mean gets as many decimals
constexpr int k_most_decimals = 6;

/// Decimals for `digits` significant digits.
int decimals_of(double value, int digits) {
  if (value == 0 || !std::isfinite(value) || value == std::round(value)) return 0;
  const int before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return std::clamp(digits - before_point, 0, k_most_decimals);
}

std::string to_text(const Spread& spread) {
  if (spread.count == 0) return "-";
  const int decimals_of_mean = decimals_of(spread.mean, k_digits);
  const int decimals = spread.deviation == 0 ? decimals_of_mean
                                             : std::min(decimals_of(spread.deviation, k_deviation_digits),
                                                        decimals_of_mean + k_deviation_digits);
  if (spread.count == 1) return fmt::format("{:.{}f} ± ?", spread.mean, decimals);
  return fmt::format("{:.{}f} ± {:.{}f}", spread.mean, decimals, spread.deviation, decimals);
}

/// Width in characters: the bytes of a UTF-8 text that do not continue a character.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string padding(width - width_of(text), ' ');
  return to_the_right ? padding + text : text + padding;
}

bool has_spread(const Table& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(), [column](const std::vector<TableCell>& row) {
    return std::holds_alternative<Spread>(row[column]);
  });
}

std::string in_quotes(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

/// One field, or two in a column of spreads.
std::string csv_fields(const TableCell& cell, bool two) {
  std::string second = two ? "," : "";
  if (const auto* text = std::get_if<std::string>(&cell)) return in_quotes(*text) + second;
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}{}", *number, second);
  const auto& spread = std::get<Spread>(cell);
  if (spread.count == 0) return second;
  return spread.count == 1 ? fmt::format("{},", spread.mean) : fmt::format("{},{}", spread.mean, spread.deviation);
}

}  // namespace

std::string to_text(const TableCell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* number = std::get_if<double>(&cell)) {
    return fmt::format("{:.{}f}", *number, decimals_of(*number, k_digits));
  }
  return to_text(std::get<Spread>(cell));
}

std::string to_markdown(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t column = 0; column < table.columns.size(); ++column) {
    widths.push_back(width_of(table.columns[column]));
    for (const std::vector<TableCell>& row : table.rows)
      widths[column] = std::max(widths[column], width_of(to_text(row[column])));
  }
  std::string text = fmt::format("## {}\n{}{}\n|", table.title, table.note, table.note.empty() ? "" : "\n");
  for (std::size_t i = 0; i < widths.size(); ++i)
    text += fmt::format(" {} |", padded(table.columns[i], widths[i], false));
  text += "\n|";
  for (const std::size_t width : widths) text += std::string(width + 2, '-') + '|';
  for (const std::vector<TableCell>& row : table.rows) {
    text += "\n|";
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const bool is_text = std::holds_alternative<std::string>(row[i]);
      text += fmt::format(" {} |", padded(to_text(row[i]), widths[i], !is_text));
    }
  }
  return text + '\n';
}

std::string to_csv(const Table& table) {
  std::string text;
  std::vector<bool> two;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    two.push_back(has_spread(table, i));
    if (i > 0) text += ',';
    text += in_quotes(table.columns[i]);
    if (two[i]) text += fmt::format(",{}", in_quotes(table.columns[i] + " sd"));
  }
  for (const std::vector<TableCell>& row : table.rows) {
    text += '\n';
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      text += csv_fields(row[i], two[i]);
    }
  }
  return text + '\n';
}

}  // namespace cloud2csg
