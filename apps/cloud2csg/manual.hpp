#pragma once

#include <string>

#include "catalogue.hpp"

namespace cloud2csg::app {

/// The page of the manual of one command, in roff. `program` has all commands, for cross references.
[[nodiscard]] std::string manual_page(const CommandEntry& command, const CommandEntry& program);

}  // namespace cloud2csg::app
