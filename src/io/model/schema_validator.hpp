#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// Keys and indices from a JSON value down to a field of it.
using FieldPath = std::vector<std::string>;

/// Checks single JSON values against the definitions of the model's schema. Shallow: primitives and tree nodes inside
/// a value are not looked at. The reader visits them one by one, each against the definition of its own type, so
/// that a message can name the field at fault (a failed `oneOf` cannot), and so that no tree is too deep.
class SchemaValidator {
 public:
  /// Compiles every definition; takes about a millisecond.
  explicit SchemaValidator(const nlohmann::json& schema);
  ~SchemaValidator();
  SchemaValidator(const SchemaValidator&) = delete;
  SchemaValidator& operator=(const SchemaValidator&) = delete;
  SchemaValidator(SchemaValidator&&) = delete;
  SchemaValidator& operator=(SchemaValidator&&) = delete;

  /// Where `value` breaks the definition, innermost fields first; empty when it does not.
  [[nodiscard]] std::vector<FieldPath> violations(std::string_view definition, const nlohmann::json& value) const;

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
};

/// A JSON value in few words, for messages: numbers and short texts as they are, "a list of 3", "an object".
[[nodiscard]] std::string brief(const nlohmann::json& value);

/// Turns the places at which `value` breaks a definition into one message about the most telling of them: the path of
/// the field, what the schema expects there (its "description") and what was found.
/// `value_path` is the JSON pointer of `value` in its file. Precondition: `violations` is not empty.
[[nodiscard]] Error::Parts explain_violation(const nlohmann::json& schema, std::string_view definition,
                                             const nlohmann::json& value, const std::vector<FieldPath>& violations,
                                             const std::string& value_path);

}  // namespace cloud2csg
