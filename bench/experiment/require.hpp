#pragma once

#include <string>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// Refuses an option by its name.
inline void require(bool holds, const char* field, const std::string& expected) {
  if (!holds) throw Error({.file = {}, .where = field, .expected = expected, .remedy = {}});
}

}  // namespace cloud2csg
