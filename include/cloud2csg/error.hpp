#pragma once

#include <exception>
#include <string>
#include <vector>

namespace cloud2csg {

/// The one exception type for bad input (files, options, models). Programming errors are assertions instead.
///
/// `what()` is one line, `file: where: expected; remedy`, without empty parts. It has at most 200 bytes besides the
/// file name: a long `where`, and then a long `expected`, is shortened.
class Error : public std::exception {
 public:
  struct Parts {
    std::string file = {};      ///< the file at fault; empty when the input is not a file
    std::string where = {};     ///< line, byte, or path of the field, e.g. "line 12", "/primitives/3/radius"
    std::string expected = {};  ///< the expected and the actual input
    std::string remedy = {};    ///< how to fix it; may be empty
    std::vector<std::string> warnings = {};  ///< doubts that came before it where no solid was found; not in what()
  };

  explicit Error(Parts parts);

  [[nodiscard]] const char* what() const noexcept override { return message_.c_str(); }
  [[nodiscard]] const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
  std::string message_;
};

/// The error for a bad field of an options struct: "search.elites: expected 0 or more, found -1". Texts put field names
/// between `backticks`, so that other languages can replace them by their own names.
[[nodiscard]] Error invalid_option(std::string field, std::string expected, std::string remedy = {});

/// Thrown by stages without a partial result when the caller's stop token is triggered.
class Cancelled : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

}  // namespace cloud2csg
