#pragma once

#include <string>
#include <utility>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// Refuses a value of a primitive: "where: expected ...; remedy". @throws Error always
[[noreturn]] inline void refuse_primitive(std::string where, const std::string& expected, std::string remedy = {}) {
  throw Error({.where = std::move(where), .expected = "expected " + expected, .remedy = std::move(remedy)});
}

}  // namespace cloud2csg
