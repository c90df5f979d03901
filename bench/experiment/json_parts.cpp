#include "bench/experiment/json_parts.hpp"

#include <fmt/format.h>

#include "bench/experiment/step.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

constexpr std::string_view k_all_steps = "extraction";

}  // namespace

Json stages_json(const StageSeconds& seconds) {
  Json json;
  for (const Step& step : extraction_steps()) json[std::string(step.name)] = seconds.*step.seconds;
  json[std::string(k_all_steps)] = seconds.extraction;
  return json;
}

StageSeconds stages_from(const Json& json) {
  StageSeconds seconds;
  for (const Step& step : extraction_steps()) seconds.*step.seconds = json.at(std::string(step.name));
  seconds.extraction = json.at(std::string(k_all_steps));
  return seconds;
}

Json tree_json(const TreeStatistics& tree) {
  return {{"size", tree.size}, {"leaves", tree.leaves}, {"depth", tree.depth}};
}

TreeStatistics tree_from(const Json& json) {
  return {.size = json.at("size"), .leaves = json.at("leaves"), .depth = json.at("depth")};
}

Json environment_json(const Environment& e) {
  return {{"version", e.version}, {"compiler", e.compiler}, {"cpu", e.cpu}, {"cores", e.cores}};
}

Environment environment_from(const Json& json) {
  return {
      .version = json.at("version"), .compiler = json.at("compiler"), .cpu = json.at("cpu"), .cores = json.at("cores")};
}

void refuse_results(const std::filesystem::path& file, const ResultsFormat& format, const std::string& expected) {
  throw Error({.file = file.string(), .expected = expected, .remedy = std::string(format.remedy)});
}

Json read_results_json(const std::filesystem::path& file, const ResultsFormat& format) {
  Json json = Json::parse(read_text_file(file), nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) refuse_results(file, format, "it is not JSON");
  if (!json.is_object() || json.value("format", Json()) != format.name ||
      json.value("format_version", Json()) != format.version) {
    refuse_results(file, format, fmt::format("it holds no {}", format.what));
  }
  return json;
}

}  // namespace cloud2csg
