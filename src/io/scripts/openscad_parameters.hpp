#pragma once

#include <string>

#include "io/scripts/script_text.hpp"

namespace cloud2csg::openscad {

/// The named values of a solid: a section of OpenSCAD's customiser.
class Parameters {
 public:
  /// Both must outlive it.
  Parameters(const std::string& solid, script::UniqueNames& variables) : solid_(solid), variables_(variables) {}

  /// Adds `<solid>_<what> = <value>;` and gives the variable's name.
  [[nodiscard]] std::string add(const std::string& what, const std::string& value);

  /// Adds a comment.
  void remark(const std::string& text) { lines_ += script::comment(text, "// "); }

  /// `/* [solid] */` and the values; nothing when there are none.
  [[nodiscard]] std::string section() const;

 private:
  const std::string& solid_;
  script::UniqueNames& variables_;
  std::string lines_ = {};
};

}  // namespace cloud2csg::openscad
