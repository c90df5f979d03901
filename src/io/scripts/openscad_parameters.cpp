#include "io/scripts/openscad_parameters.hpp"

#include <fmt/format.h>

namespace cloud2csg::openscad {

std::string Parameters::add(const std::string& what, const std::string& value) {
  std::string name = variables_.take(solid_ + "_" + what);
  lines_ += fmt::format("{} = {};\n", name, value);
  return name;
}

std::string Parameters::section() const {
  return lines_.empty() ? std::string() : fmt::format("\n/* [{}] */\n{}", solid_, lines_);
}

}  // namespace cloud2csg::openscad
