#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

namespace cloud2csg::app {

/// A value, or the values of a list, as the command line would have them; empty when there is something else in it.
[[nodiscard]] std::vector<std::string> texts_of(const toml::node& value);

/// The value that texts_of() reads as these texts: bare where it is a number, else in quotes; a list of several.
[[nodiscard]] std::string toml_of(const std::vector<std::string>& texts);

}  // namespace cloud2csg::app
