#include "overwriting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "cloud2csg/error.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::streamsize k_looked_at = 4096;

enum class Beginning : std::uint8_t {
  is_it,     ///< the file begins so, letters in either case
  within_it  ///< it is near the file's beginning
};

struct Kind {
  std::string_view ending;
  std::string_view name;
  std::string_view mark;
  Beginning beginning = Beginning::is_it;
};

/// Kinds of files that have a mark, or one of several. Binary .stl begins with anything; all others are text.
constexpr std::array<Kind, 11> k_marked{
    {{".html", "HTML page", "<!doctype html>"},
     {".json", "model or statistics of cloud2csg", R"("format":"cloud2csg")", Beginning::within_it},
     {".json", "", "\"unassigned_points\":", Beginning::within_it},
     {".png", "PNG picture", "\x89PNG"},
     {".ply", "PLY file", "ply"},
     {".3mf", "3MF archive", "PK\x03\x04"},
     {".pcd", "PCD file", "version ", Beginning::within_it},
     {".off", "OFF file", "off", Beginning::within_it},
     {".step", "STEP file", "ISO-10303-21"},
     {".stp", "STEP file", "ISO-10303-21"},
     {".brep", "BREP file", "CASCADE", Beginning::within_it}}};

std::string beginning_of(const std::filesystem::path& file) {
  std::ifstream older(file, std::ios::binary);
  std::string begin(static_cast<std::size_t>(k_looked_at), '\0');
  older.read(begin.data(), k_looked_at);
  begin.resize(static_cast<std::size_t>(older.gcount()));
  return begin;
}

bool is_same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

bool has(std::string_view text, std::string_view mark, Beginning beginning) {
  const auto at = std::search(text.begin(), text.end(), mark.begin(), mark.end(), is_same_letter);
  return beginning == Beginning::within_it ? at != text.end() : at == text.begin();
}

/// JSON is the same with spaces or without.
std::string without_spaces(std::string_view text) {
  std::string kept(text);
  std::erase_if(kept, [](unsigned char letter) { return std::isspace(letter) != 0; });
  return kept;
}

bool bears(std::string_view begin, const Kind& kind) {
  if (kind.ending == ".json") return has(without_spaces(begin), kind.mark, kind.beginning);
  return has(begin, kind.mark, kind.beginning);
}

}  // namespace

void check_overwriting(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  const std::string begin = beginning_of(file);
  if (begin.empty()) return;
  const std::string ending = lower_ending(file);
  const auto kind = std::ranges::find(k_marked, ending, &Kind::ending);
  const bool is_marked = kind != k_marked.end();
  const bool bears_mark =
      std::ranges::any_of(k_marked, [&](const Kind& one) { return one.ending == ending && bears(begin, one); });
  const bool is_of_kind = is_marked ? bears_mark : ending == ".stl" || begin.find('\0') == std::string::npos;
  if (is_of_kind) return;
  throw Error({.file = file.string(),
               .where = {},
               .expected = fmt::format("is there already and is no {}", is_marked ? kind->name : "text"),
               .remedy = "remove it, or choose another name"});
}

}  // namespace cloud2csg::app
