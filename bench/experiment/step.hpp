#pragma once

#include <span>
#include <string_view>

#include "cloud2csg/extract.hpp"

namespace cloud2csg {

struct Step {
  std::string_view name;
  double StageSeconds::*seconds;
};
/// In order of execution.
[[nodiscard]] std::span<const Step> extraction_steps();

}  // namespace cloud2csg
