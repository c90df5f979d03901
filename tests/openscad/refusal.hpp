#pragma once

#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"

namespace cloud2csg::test {

/// What the reader says against a text, or "accepted".
inline std::string refusal(const std::string& text) {
  try {
    (void)parse_openscad(text, "part.scad");
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace cloud2csg::test
