#include "experiment/json_parts.hpp"

#include <fmt/format.h>

#include "base/atomic_file.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

template <typename Seconds, typename Visit>
void visit_stages(Seconds& s, const Visit& visit) {
  visit("segment", s.segment);
  visit("overlap", s.overlap);
  visit("partition", s.partition);
  visit("classes", s.classes);
  visit("search", s.search);
  visit("merge", s.merge);
  visit("simplify", s.simplify);
  visit("extraction", s.extraction);
}

}  // namespace

Json stages_json(const StageSeconds& seconds) {
  Json json;
  visit_stages(seconds, [&json](const char* name, double value) { json[name] = value; });
  return json;
}

StageSeconds stages_from(const Json& json) {
  StageSeconds seconds;
  visit_stages(seconds, [&json](const char* name, double& value) { value = json.at(name); });
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
  throw Error({.file = file.string(), .where = {}, .expected = expected, .remedy = std::string(format.remedy)});
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
