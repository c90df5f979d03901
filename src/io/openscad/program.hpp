#pragma once

#include "cloud2csg/model.hpp"
#include "io/openscad/terms.hpp"

namespace cloud2csg::scad {

/// Reads a model from OpenSCAD text. O(n log n) @throws Refusal
[[nodiscard]] Model read_program(std::string_view text);

}  // namespace cloud2csg::scad
