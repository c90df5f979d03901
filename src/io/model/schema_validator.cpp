// The only translation unit that includes valijson: it takes 13 seconds to compile.
#include "io/model/schema_validator.hpp"

#include <cassert>
#include <map>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace cloud2csg {
namespace {

/// The schema with the definitions that recurse replaced by "anything".
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

}  // namespace cloud2csg
