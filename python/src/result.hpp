#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "cloud.hpp"
#include "cloud2csg/extract.hpp"
#include "model.hpp"

namespace cloud2csg::python {

/// The result of extract() or detect(). Cloud, model and surfaces are shared with Python.
struct Result {
  std::shared_ptr<Cloud> cloud;
  std::shared_ptr<Model> model;
  std::vector<std::shared_ptr<DetectedSurface>> surfaces;
  ExtractStatistics statistics;
};

/// `given`: the result's cloud, unless `found` has one of its own.
[[nodiscard]] inline Result result_of(Extraction found, const std::shared_ptr<Cloud>& given) {
  Result result{.cloud = given,
                .model = std::make_shared<Model>(std::move(found.model)),
                .surfaces = {},
                .statistics = std::move(found.statistics)};
  if (found.cloud.size() > 0) result.cloud = std::make_shared<Cloud>(std::move(found.cloud), given->is_exact());
  for (DetectedSurface& surface : found.surfaces) {
    result.surfaces.push_back(std::make_shared<DetectedSurface>(std::move(surface)));
  }
  std::vector<std::string>& warnings = result.statistics.warnings;
  warnings.insert(warnings.begin(), given->warnings().begin(), given->warnings().end());
  return result;
}

}  // namespace cloud2csg::python
