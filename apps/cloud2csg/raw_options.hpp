#pragma once

#include "cloud2csg/input.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "field_arguments.hpp"

/// The options of the way from a raw cloud or mesh to primitives, which `extract` and `detect` have.
namespace cloud2csg::app {

inline void add_raw_options(FieldArguments& fields, ReconstructOptions& options, InputOptions& reading) {
  fields.add(options, {.group = "Finding primitives"});
  fields.add(reading, {.group = "Finding primitives"});
}

/// One seed for all that is random, and no more points of a mesh than would be kept.
inline void share_values(ReconstructOptions& options, InputOptions& reading) {
  const std::uint64_t seed = options.extraction.seed;
  options.detection.seed = options.solids.places.seed = reading.seed = seed;
  reading.mesh_points = std::min(reading.mesh_points, options.preparation.clean.point_budget);
}

/// Points drawn from a mesh lie on it, and so do not have to be looked at.
[[nodiscard]] inline ReconstructOptions options_for(const Input& input, ReconstructOptions options) {
  options.preparation.is_exact = input.mesh.has_value() && options.preparation.keep_normals;
  return options;
}

}  // namespace cloud2csg::app
