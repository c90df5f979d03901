#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "bench/experiment/paper.hpp"

/// What the results of all experiments hold, as JSON. Reading throws Json::exception.
namespace cloud2csg {

using Json = nlohmann::ordered_json;

/// Of what an extraction is measured in; the fields of the command line are left out.
[[nodiscard]] Json stages_json(const StageSeconds& seconds);
[[nodiscard]] StageSeconds stages_from(const Json& json);

[[nodiscard]] Json tree_json(const TreeStatistics& tree);
[[nodiscard]] TreeStatistics tree_from(const Json& json);

[[nodiscard]] Json environment_json(const Environment& environment);
[[nodiscard]] Environment environment_from(const Json& json);

/// A kind of results file.
struct ResultsFormat {
  std::string_view name;  ///< of the field "format"
  int version;            ///< of the field "format_version"
  std::string_view what;  ///< for messages: "results of ..."
  std::string_view remedy;
};

[[noreturn]] void refuse_results(const std::filesystem::path& file, const ResultsFormat& format,
                                 const std::string& expected);

/// @throws Error when the file is not JSON of this format
[[nodiscard]] Json read_results_json(const std::filesystem::path& file, const ResultsFormat& format);

/// read_results_json(), then `from`. @throws Error for fields that are missing or of the wrong type, too.
template <typename From>
auto read_results(const std::filesystem::path& file, const ResultsFormat& format, const From& from) {
  const Json json = read_results_json(file, format);
  try {
    return from(json);
  } catch (const Json::exception& error) {
    refuse_results(file, format, std::string("a field is missing or of the wrong type: ") + error.what());
  }
}

}  // namespace cloud2csg
