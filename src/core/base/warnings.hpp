#pragma once

#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// The result of `work`. If it throws an Error, `warnings` come before its own; a class derived from Error stays as it
/// is.
template <typename Work>
auto with_warnings(const std::vector<std::string>& warnings, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (warnings.empty() || typeid(error) != typeid(Error)) throw;
    Error::Parts parts = error.parts();
    parts.warnings.insert(parts.warnings.begin(), warnings.begin(), warnings.end());
    throw Error(std::move(parts));
  }
}

}  // namespace cloud2csg
