#pragma once

#include <algorithm>
#include <utility>

#include "cloud2csg/input.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "field_arguments.hpp"

/// Options from a raw cloud or mesh to primitives, shared by `extract` and `detect`.
namespace cloud2csg::app {

inline void add_cloud(CLI::App& app, std::string& file) {
  const std::string help =
      "Point cloud: " + endings_read({FileKind::cloud}) + ", or mesh: " + endings_read({FileKind::mesh});
  add_file(app, "cloud", file, help)->type_name("CLOUD|MESH");
}

inline CLI::Option* add_primitives(CLI::App& app, std::string& file, const std::string& help) {
  const std::string whole = "Model " + endings_read({FileKind::model}) + help;
  return app.add_option("--primitives", file, whole)->check(file_name())->type_name("MODEL")->group("Input");
}

/// Cloud and primitives may be in one file; an empty name means none.
[[nodiscard]] inline std::vector<std::string> inputs_of(const std::string& cloud, const std::string& primitives) {
  return primitives.empty() || primitives == cloud ? std::vector{cloud} : std::vector{cloud, primitives};
}

inline void add_raw_options(FieldArguments& fields, ReconstructOptions& options, InputOptions& reading) {
  fields.add(options, {.group = "Finding primitives"});
  fields.add(reading, {.group = "Finding primitives"});
}

/// Shares the seed, and draws no more points from a mesh than the point budget keeps.
inline void share_values(ReconstructOptions& options, InputOptions& reading) {
  reading.seed = options.extraction.seed;
  options = with_seed(std::move(options), reading.seed);
  reading.mesh_points = std::min(reading.mesh_points, options.preparation.clean.point_budget);
}

/// Points drawn from an exact mesh need no cleaning.
[[nodiscard]] inline ReconstructOptions options_for(const Input& input, ReconstructOptions options) {
  options.preparation.is_exact = input.is_exact && options.preparation.keep_normals;
  return options;
}

}  // namespace cloud2csg::app
