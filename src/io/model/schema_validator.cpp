#include "io/model/schema_validator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <map>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace cloud2csg {
namespace {

/// The schema with its recursive definitions replaced by "anything".
nlohmann::json without_nesting(nlohmann::json schema) {
  for (const char* nested : {"primitive", "node"}) schema["definitions"][nested] = nlohmann::json::object();
  return schema;
}

/// valijson names a place as "<root>", "[key]", "[index]"...
FieldPath path_of(const std::vector<std::string>& context) {
  FieldPath path;
  for (std::size_t i = 1; i < context.size(); ++i) path.push_back(context[i].substr(1, context[i].size() - 2));
  return path;
}

using nlohmann::json;

constexpr std::size_t k_longest_text = 40;

const json& resolve(const json& schema, const json& subschema) {
  const auto reference = subschema.find("$ref");
  if (reference == subschema.end()) return subschema;
  return schema.at(json::json_pointer(reference->get<std::string>().substr(1)));
}

/// The part of the schema for the field at `path` below a value of the definition.
const json& rules_at(const json& schema, std::string_view definition, const FieldPath& path) {
  const json* rules = &schema.at("definitions").at(std::string(definition));
  for (const std::string& step : path) {
    const json& inner = rules->contains("properties") ? rules->at("properties").at(step) : rules->at("items");
    rules = &resolve(schema, inner);
  }
  return *rules;
}

const json& value_at(const json& value, const FieldPath& path) {
  const json* inner = &value;
  for (const std::string& step : path) inner = inner->is_array() ? &inner->at(std::stoul(step)) : &inner->at(step);
  return *inner;
}

std::string pointer(const std::string& value_path, const FieldPath& path) {
  json::json_pointer below;
  for (const std::string& step : path) below.push_back(step);
  return value_path + below.to_string();
}

std::vector<std::string> field_names(const json& rules) {
  std::vector<std::string> names;
  for (const auto& property : rules.at("properties").items()) names.push_back(property.key());
  return names;
}

std::string unknown_field(const json& rules, const json& value) {
  for (const auto& field : value.items()) {
    if (!rules.at("properties").contains(field.key())) return field.key();
  }
  return {};
}

std::string missing_field(const json& rules, const json& value) {
  for (const json& name : rules.value("required", json::array())) {
    if (!value.contains(name.get<std::string>())) return name.get<std::string>();
  }
  return {};
}

}  // namespace

struct SchemaValidator::Compiled {
  std::map<std::string, valijson::Schema, std::less<>> definitions = {};
};

SchemaValidator::SchemaValidator(const nlohmann::json& schema) : compiled_(std::make_unique<Compiled>()) {
  nlohmann::json document = without_nesting(schema);
  for (const auto& definition : schema.at("definitions").items()) {
    document["$ref"] = "#/definitions/" + definition.key();
    const valijson::adapters::NlohmannJsonAdapter adapter(document);
    valijson::SchemaParser().populateSchema(adapter, compiled_->definitions[definition.key()]);
  }
}

SchemaValidator::~SchemaValidator() = default;

std::vector<FieldPath> SchemaValidator::violations(std::string_view definition, const nlohmann::json& value) const {
  const auto schema = compiled_->definitions.find(definition);
  assert(schema != compiled_->definitions.end());
  valijson::Validator validator;
  valijson::ValidationResults results;
  validator.validate(schema->second, valijson::adapters::NlohmannJsonAdapter(value), &results);
  std::vector<FieldPath> paths;
  for (const valijson::ValidationResults::Error& error : results) paths.push_back(path_of(error.context));
  return paths;
}

std::string brief(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  // Invalid UTF-8 must not make the message itself throw.
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() <= k_longest_text ? text : fmt::format("a text of {} bytes", text.size());
}

Error::Parts explain_violation(const json& schema, std::string_view definition, const json& value,
                               const std::vector<FieldPath>& violations, const std::string& value_path) {
  assert(!violations.empty());
  // An unknown field is usually a misspelt one and explains a missing one, so it goes first.
  for (const FieldPath& path : violations) {
    const json& rules = rules_at(schema, definition, path);
    const json& found = value_at(value, path);
    if (!found.is_object() || !rules.contains("properties")) continue;
    const std::string unknown = unknown_field(rules, found);
    if (unknown.empty()) continue;
    FieldPath unknown_path = path;
    unknown_path.push_back(unknown);
    return {.where = pointer(value_path, unknown_path),
            .expected = "unknown field",
            .remedy = fmt::format("{} has the fields {}", rules.at("description").get<std::string>(),
                                  fmt::join(field_names(rules), ", "))};
  }
  FieldPath path = violations.front();
  const json& found = value_at(value, path);
  const json& rules = rules_at(schema, definition, path);
  std::string found_text = brief(found);
  if (const std::string missing = found.is_object() && rules.contains("properties") ? missing_field(rules, found) : "";
      !missing.empty()) {
    path.push_back(missing);
    found_text = "nothing";
  }
  const json& expected = rules_at(schema, definition, path);
  return {.where = pointer(value_path, path),
          .expected = fmt::format("expected {}, found {}",
                                  expected.contains("description") ? expected.at("description").get<std::string>()
                                                                   : expected.value("const", json()).dump(),
                                  found_text)};
}

}  // namespace cloud2csg
