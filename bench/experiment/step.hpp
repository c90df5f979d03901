#pragma once

#include <span>
#include <string_view>

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

/// A step of the extraction that is timed.
struct Step {
  std::string_view name;
  double StageSeconds::*seconds;
};
/// In their order.
[[nodiscard]] std::span<const Step> extraction_steps();

}  // namespace cloud2csg
