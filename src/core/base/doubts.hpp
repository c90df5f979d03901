#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

/// The result of `work`. Adds doubts from before it to an Error.
template <typename Work>
auto after_doubts(const std::vector<std::string>& doubts, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    if (doubts.empty()) throw;
    Error::Parts parts = error.parts();
    parts.warnings.insert(parts.warnings.begin(), doubts.begin(), doubts.end());
    throw Error(std::move(parts));
  }
}

}  // namespace cloud2csg
