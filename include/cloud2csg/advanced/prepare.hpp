#pragma once

#include <string>
#include <vector>

#include "cloud2csg/advanced/clean.hpp"
#include "cloud2csg/advanced/normals.hpp"
#include "cloud2csg/advanced/scale.hpp"

namespace cloud2csg {

/// Its fields: see the table.
struct PrepareOptions {
  CleanOptions clean = {};
  bool is_exact = false, keep_normals = true;
};
void option_table(OptionsOf<PrepareOptions>, auto&& field) {
  using O = PrepareOptions;
  field(&O::clean, "clean", "Which points are left out");
  field(&O::is_exact, "is_exact",
        "The points lie on the surface and have its normals, as those drawn from a mesh: they are taken as they are, "
        "and only measured",
        k_library);
  field(&O::keep_normals, "keep_normals",
        "Keep given normals that are plausible: scanners know more than positions tell",
        {.opposite = "estimate-normals", .otherwise = "Do not use the normals that the cloud has"});
}

struct PreparedCloud {
  PointCloud cloud;  ///< with outward normals
  Scale scale;       ///< of the cleaned cloud
  CleanReport cleaning;
  bool normals_estimated = false;
  double clean_seconds = 0, normals_seconds = 0;
  std::vector<std::string> warnings = {};  ///< sentences for the user: what was changed, what is doubtful, and where
};

/// From a raw cloud to one that primitives can be detected in: measured, cleaned, with normals out of the solid. Given
/// normals that lead inward are turned, those that are of no use estimated anew. O(n log n)
/// @throws Error for too few points, before or after cleaning, or a wrong option; Cancelled.
[[nodiscard]] PreparedCloud prepare_cloud(const PointCloud& cloud, const PrepareOptions& options = {},
                                          const RunContext& run = {});

}  // namespace cloud2csg
