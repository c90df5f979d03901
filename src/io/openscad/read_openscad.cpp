#include "io/openscad/read_openscad.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "core/base/run_program.hpp"
#include "core/base/text.hpp"
#include "io/openscad/program.hpp"

namespace cloud2csg {
namespace {

/// "line 3, column 5", counted in characters.
std::string place_of(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const std::size_t begin = before.rfind('\n') + 1;  // 0 in the first line
  // Ignores UTF-8 continuation bytes.
  const auto column =
      std::ranges::count_if(before.substr(begin), [](char c) { return (static_cast<unsigned char>(c) >> 6U) != 2; });
  return fmt::format("line {}, column {}", 1 + std::ranges::count(before, '\n'), 1 + column);
}

Error::Parts parts_of(const scad::Refusal& refusal, std::string_view text, const std::string& name) {
  return {.file = name,
          .where = place_of(text, refusal.offset),
          .expected = refusal.expected,
          .remedy = "let OpenSCAD flatten it (-o part.csg), or extract a tree from its mesh (-o part.stl)"};
}

/// The messages of OpenSCAD that begin with `word`, without it.
std::vector<std::string> lines_after(const std::string& word, const std::string& said) {
  std::vector<std::string> lines;
  std::istringstream all(said);
  for (std::string line; std::getline(all, line);) {
    if (line.starts_with(word)) lines.push_back(line.substr(word.size()));
  }
  return lines;
}

Model read_flattened(const std::filesystem::path& file, Error::Parts refused) {
  constexpr std::chrono::seconds k_limit(60);  // meshing takes hours at times, flattening does not
  const ScratchFile flat(".csg");
  const ScratchFile said(".txt");
  const auto fail = [&refused](std::string remedy) {
    refused.remedy = std::move(remedy);
    throw Error(refused);
  };
  const RunEnd end = run_program({"openscad", "-o", flat.path().string(), std::filesystem::absolute(file).string()},
                                 said.path(), said.path(), k_limit);
  const std::string answer = read_text_file(said.path());
  const std::vector<std::string> errors = lines_after("ERROR: ", answer);
  if (end == RunEnd::not_installed) fail("install OpenSCAD, which flattens files that cloud2csg cannot read");
  if (end == RunEnd::too_late) fail(fmt::format("OpenSCAD did not flatten the file within {} s", k_limit.count()));
  if (end == RunEnd::failed || !errors.empty()) {
    constexpr std::size_t k_longest = 100;
    fail("OpenSCAD says: " + visible_text(errors.empty() ? answer.substr(0, answer.find('\n')) : errors[0], k_longest));
  }
  const std::string text = read_text_file(flat.path());
  Model model;
  try {
    model = scad::read_program(text);
  } catch (const scad::Refusal& refusal) {
    if (refused.expected != refusal.expected) refused.where = "flattened by OpenSCAD";
    refused.expected = refusal.expected;
    fail("extract a tree from a mesh of it (openscad -o part.stl)");
  }
  model.warnings.push_back(
      fmt::format("OpenSCAD flattened {}, which loses names and digits beyond six. The reason is at {}: {}.",
                  file.filename().string(), refused.where, refused.expected));
  constexpr std::size_t k_most = 5;
  const std::vector<std::string> doubts = lines_after("WARNING: ", answer);
  for (std::size_t i = 0; i < std::min(k_most, doubts.size()); ++i) {
    model.warnings.push_back("OpenSCAD says: " + doubts[i]);
  }
  return model;
}

}  // namespace

Model parse_openscad(std::string_view text, const std::string& name) {
  try {
    Model model = scad::read_program(text);
    model.description = "read from " + name;
    return model;
  } catch (const scad::Refusal& refusal) {
    throw Error(parts_of(refusal, text, name));
  }
}

Model read_openscad(const std::filesystem::path& file) {
  try {
    return parse_openscad(read_text_file(file), file.string());
  } catch (const Error& error) {
    if (error.parts().where.empty()) throw;
    Model model = read_flattened(file, error.parts());
    model.description = "read from " + file.string();
    return model;
  }
}

}  // namespace cloud2csg
