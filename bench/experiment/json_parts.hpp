#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/experiment/paper.hpp"

/// JSON parts shared by the results of all experiments. Reading throws Json::exception.
namespace cloud2csg {

using Json = nlohmann::ordered_json;

/// The stages within an extraction, without those of the command line.
[[nodiscard]] Json stages_json(const StageSeconds& seconds);
[[nodiscard]] StageSeconds stages_from(const Json& json);

[[nodiscard]] Json tree_json(const TreeStatistics& tree);
[[nodiscard]] TreeStatistics tree_from(const Json& json);

[[nodiscard]] Json environment_json(const Environment& environment);
[[nodiscard]] Environment environment_from(const Json& json);

template <typename Value>
[[nodiscard]] Json value_json(const Value& value) {
  if constexpr (HasNames<Value>) {
    return to_string(value);
  } else {
    return value;
  }
}
template <typename Value>
[[nodiscard]] Json value_json(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(value_json(value));
  return list;
}
template <typename Value>
void read_value(const Json& json, Value& value) {
  if constexpr (HasNames<Value>) {
    const std::optional<Value> named = enum_named<Value>(json.get<std::string>());
    if (!named) throw invalid_option("options", "unknown name " + json.get<std::string>());
    value = *named;
  } else {
    json.get_to(value);
  }
}
template <typename Value>
void read_value(const Json& json, std::vector<Value>& values) {
  values.clear();
  for (const Json& item : json) read_value(item, values.emplace_back());
}

template <HasOptionTable Options>
[[nodiscard]] Json options_json(const Options& options) {
  Json json;
  for_each_field<Options>(
      [&](auto member, const OptionField& field) { json[std::string(field.name)] = value_json(options.*member); });
  return json;
}
template <HasOptionTable Options>
[[nodiscard]] Options options_from(const Json& json) {
  Options options;
  for_each_field<Options>(
      [&](auto member, const OptionField& field) { read_value(json.at(std::string(field.name)), options.*member); });
  return options;
}

struct ResultsFormat {
  std::string_view name;  ///< value of the field "format"
  int version;            ///< value of the field "format_version"
  std::string_view what;  ///< for messages: "results of ..."
  std::string_view remedy;
};

[[noreturn]] void refuse_results(const std::filesystem::path& file, const ResultsFormat& format,
                                 const std::string& expected);

/// @throws Error when the file is not JSON of this format
[[nodiscard]] Json read_results_json(const std::filesystem::path& file, const ResultsFormat& format);

/// read_results_json(), then `from`. @throws Error also for fields that are missing or of the wrong type.
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
