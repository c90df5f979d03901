#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/scripts/script_plan.hpp"
#include "io/scripts/script_text.hpp"
#include "io/step/kernel.hpp"

/// The common part of Python scripts: a statement a solid, then a statement an operation.
namespace cloud2csg::script {

struct SolidText {
  std::string parameters;  ///< lines that set variables
  std::string statement;   ///< the line that makes the solid from the variables
};

/// The words of a program's Python. Operands are names of solids.
struct Dialect {
  /// Makes a solid under a name; `label` may hold any character.
  std::function<SolidText(const std::string& name, const std::string& label, const brep::KernelSolid& solid)> solid;
  std::function<std::string(std::span<const std::string> operands)> unite;   ///< two or more
  std::function<std::string(std::span<const std::string> operands)> common;  ///< two or more
  /// `base` may be a result of common().
  std::function<std::string(const std::string& base, std::span<const std::string> operands)> cut;
};

/// A function of the script, written only if a statement contains `call`.
struct Function {
  const char* call;
  const char* text;
};

struct PythonBody {
  std::string parameters;  ///< for all primitives
  std::string solids;      ///< one line a primitive, ascending
  std::string operations;  ///< the last is `part = ...`
};

/// @throws Error for an empty solid
[[nodiscard]] PythonBody python_body(const Plan& plan, const PrimitiveSet& primitives, int facet_resolution,
                                     UniqueNames& names, const Dialect& dialect);

/// a, b, c, in lines of about 100 characters at most.
[[nodiscard]] std::string arguments(std::span<const std::string> operands);

/// All digits, so that Python reads the same numbers; a vector as (x, y, z).
[[nodiscard]] std::string exact(double number);
[[nodiscard]] std::string exact(const Eigen::Vector3d& vector);

/// Lists for `extrusion(regions)`: each region is [outline, hole, ...], a path is [(x, y) or (x, y, bulge), ...].
[[nodiscard]] std::string regions_text(std::span<const ProfileRegion> profile);

/// Lists for `polyhedron(shells)`: (points, faces) of each connected piece, inner pieces after outer ones.
[[nodiscard]] std::string shells_text(const brep::Facets& facets);

}  // namespace cloud2csg::script
