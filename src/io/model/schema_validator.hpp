#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

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

}  // namespace cloud2csg
