#pragma once

#include <span>
#include <string>
#include <vector>

#include "cloud2csg/extract.hpp"

namespace cloud2csg::app {

/// What an extraction found, in a few lines: points, primitives, partitions, tree, fit, time by stage, files.
[[nodiscard]] std::vector<std::string> summary_of(const ExtractStatistics& statistics,
                                                  std::span<const std::string> files);

}  // namespace cloud2csg::app
