#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

using FieldPath = std::vector<std::string>;

/// Checks single JSON values against the definitions of the model's schema, without primitives and tree nodes inside.
/// The reader visits each of these with the definition of its type. So a message can name the faulty field (a failed
/// `oneOf` cannot), and no tree is too deep.
class SchemaValidator {
 public:
  /// Compiles every definition in about a millisecond.
  explicit SchemaValidator(const nlohmann::json& schema);
  ~SchemaValidator();
  SchemaValidator(const SchemaValidator&) = delete;
  SchemaValidator& operator=(const SchemaValidator&) = delete;
  SchemaValidator(SchemaValidator&&) = delete;
  SchemaValidator& operator=(SchemaValidator&&) = delete;

  /// The places where `value` violates the definition, innermost first; empty if it is valid.
  [[nodiscard]] std::vector<FieldPath> violations(std::string_view definition, const nlohmann::json& value) const;

 private:
  struct Compiled;
  std::unique_ptr<Compiled> compiled_;
};

/// A short form of a JSON value for messages: numbers and short texts as they are, "a list of 3", "an object".
[[nodiscard]] std::string brief(const nlohmann::json& value);

/// The most telling violation as a message: the path of the field, what the schema expects there (its "description")
/// and what was found. `value_path` is the JSON pointer of `value`. Precondition: `violations` is not empty.
[[nodiscard]] Error::Parts explain_violation(const nlohmann::json& schema, std::string_view definition,
                                             const nlohmann::json& value, const std::vector<FieldPath>& violations,
                                             const std::string& value_path);

}  // namespace cloud2csg
