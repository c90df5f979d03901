#pragma once

#include <string>
#include <string_view>

namespace cloud2csg {

/// A gnuplot script that includes its data and prints an .svg.
struct Figure {
  std::string name;  ///< file name without the ending
  std::string script;
};

inline constexpr std::string_view k_figure_style =
    R"(set terminal svg size 900,480 font "sans-serif,14" background rgb "white" noenhanced
set grid ytics
set key outside right top
)";

[[nodiscard]] inline std::string in_gnuplot_quotes(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace cloud2csg
