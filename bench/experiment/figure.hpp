#pragma once

#include <string>
#include <string_view>

namespace cloud2csg {

/// A script for gnuplot, data included, that prints an .svg.
struct Figure {
  std::string name;  ///< of its file, without the ending
  std::string script;
};

/// The beginning of each script.
inline constexpr std::string_view k_figure_style =
    R"(set terminal svg size 900,480 font "sans-serif,14" background rgb "white" noenhanced
set grid ytics
set key outside right top
)";

/// Text in quotes, as gnuplot reads it.
[[nodiscard]] inline std::string in_gnuplot_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace cloud2csg
