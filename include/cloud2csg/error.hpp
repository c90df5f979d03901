#pragma once

#include <exception>
#include <string>

namespace cloud2csg {

/// Bad input: one exception type, thrown where input enters the library (files, options, models).
/// Programming errors are assertions instead.
///
/// `what()` is one line: `file: where: expected; remedy`, empty parts left out; of at most 200 bytes beside the file,
/// to which a long place, and then a long `expected`, are cut.
class Error : public std::exception {
 public:
  struct Parts {
    std::string file = {};      ///< the file at fault; empty when the input is not a file
    std::string where = {};     ///< line, byte, or path of the field, e.g. "line 12", "/primitives/3/radius"
    std::string expected = {};  ///< what was expected and what was found
    std::string remedy = {};    ///< what to do about it; may be empty
  };

  explicit Error(Parts parts);

  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }
  [[nodiscard]] const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
  std::string message_;
};

/// Refuses a field of an options struct: "search.elites: expected 0 or more, found -1". Fields that texts speak of
/// stand in `these`: other languages than C++ have names of their own for them.
[[nodiscard]] Error invalid_option(std::string field, std::string expected, std::string remedy = {});

/// Thrown by stages that have no partial result when the caller's stop token is triggered.
class Cancelled : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace cloud2csg
