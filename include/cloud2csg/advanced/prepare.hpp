#pragma once

#include <string>
#include <vector>

#include "cloud2csg/advanced/clean.hpp"
#include "cloud2csg/advanced/normals.hpp"
#include "cloud2csg/advanced/scale.hpp"

namespace cloud2csg {

struct PrepareOptions {
  CleanOptions clean = {};
  /// The points lie on the surface and have its normals, as those drawn from a mesh: they are taken as they are, and
  /// only measured.
  bool is_exact = false;
  /// Keep given normals that are plausible: scanners know more than positions tell. Off: estimate them in any case.
  bool keep_normals = true;
};

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
