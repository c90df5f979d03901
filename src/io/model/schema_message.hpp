#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cloud2csg/error.hpp"
#include "io/model/schema_validator.hpp"

namespace cloud2csg {

/// A JSON value in few words, for messages: numbers and short texts as they are, "a list of 3", "an object".
[[nodiscard]] std::string brief(const nlohmann::json& value);

/// Turns the places at which `value` breaks a definition into one message about the most telling of them: the path of
/// the field, what the schema expects there (its "description") and what was found.
/// `value_path` is the JSON pointer of `value` in its file. Precondition: `violations` is not empty.
[[nodiscard]] Error::Parts explain_violation(const nlohmann::json& schema, std::string_view definition,
                                             const nlohmann::json& value, const std::vector<FieldPath>& violations,
                                             const std::string& value_path);

}  // namespace cloud2csg
