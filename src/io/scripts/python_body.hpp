#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/scripts/script_plan.hpp"
#include "io/scripts/script_text.hpp"
#include "io/step/kernel.hpp"

/// The part that Python scripts have in common: a statement a solid, then a statement an operation.
namespace cloud2csg::script {

struct SolidText {
  std::string parameters;  ///< lines that set variables
  std::string statement;   ///< the line that makes the solid of them
};

/// How a program's Python says it. Operands are names of solids.
struct Dialect {
  /// Makes a solid under a name; `label` may hold any character.
  std::function<SolidText(const std::string& name, const std::string& label, const brep::KernelSolid& solid)> solid;
  std::function<std::string(std::span<const std::string> operands)> unite;   ///< of two or more
  std::function<std::string(std::span<const std::string> operands)> common;  ///< of two or more
  /// `base` may be what common() gave.
  std::function<std::string(const std::string& base, std::span<const std::string> operands)> cut;
};

/// A function of the script, written when a statement calls it.
struct Function {
  const char* call;
  const char* text;
};

struct PythonBody {
  std::string parameters;  ///< of each primitive
  std::string solids;      ///< of each primitive one, ascending
  std::string operations;  ///< the last is `part = ...`
};

/// @throws Error when the solid is empty
[[nodiscard]] PythonBody python_body(const Plan& plan, const PrimitiveSet& primitives, int facet_resolution,
                                     UniqueNames& names, const Dialect& dialect);

/// a, b, c, in lines of no more than about 100 characters.
[[nodiscard]] std::string arguments(std::span<const std::string> operands);

/// All digits of a number, so that Python reads the same; (x, y, z).
[[nodiscard]] std::string exact(double number);
[[nodiscard]] std::string exact(const Eigen::Vector3d& vector);

/// Lists for `polyhedron(shells)`: (points, faces) of each connected piece, those inside of others after them.
[[nodiscard]] std::string shells_text(const brep::Facets& facets);

}  // namespace cloud2csg::script
