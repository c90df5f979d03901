#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// The part of OpenSCAD's language that a model can be read from, as a tree of statements.
namespace cloud2csg::scad {

/// Of statements and terms in each other. Reading is recursive: this bounds the stack, whatever a file holds.
inline constexpr std::size_t k_deepest = 1000;

/// What has a value: a number, a name, a list, a sum...
struct Term {
  enum class Kind { number, text, boolean, undefined, name, list, range, negation, denial, chain };
  Kind kind = Kind::undefined;
  std::size_t offset = 0;           ///< of its first byte in the file
  double number = 0;                ///< of a boolean, too: 0 or 1
  std::string text = {};            ///< a name or string; of a chain, the operators between its operands: "+-"
  std::vector<Term> operands = {};  ///< of a range: from where, in steps of what (where told), to where
};

struct Argument {
  std::string name;  ///< empty: told by its place
  Term value;
};

struct Statement {
  enum class Kind { call, block, assignment, module_definition };
  Kind kind = Kind::block;
  std::size_t offset = 0;
  std::string name = {};
  std::vector<Argument> arguments = {};  ///< of an assignment, its value
  std::vector<Statement> children = {};
  bool is_shown = true;  ///< false behind * and %, which OpenSCAD leaves out of the solid
};

/// Throws the error `expected` at a place of the text, as "line 3, column 5". @throws Error, always
[[noreturn]] void refuse(std::string_view text, std::size_t offset, std::string expected, std::string remedy = {});

/// What else OpenSCAD can do with its language, its own program turns into what is read here.
inline constexpr const char* k_flatten = "flatten the file first: openscad -o flat.csg FILE.scad";

/// @throws Error naming line and column for what is not in the language, or not in this part of it. O(n)
[[nodiscard]] std::vector<Statement> parse(std::string_view text);

}  // namespace cloud2csg::scad
