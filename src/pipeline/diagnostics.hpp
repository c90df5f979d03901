#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/find_primitives.hpp"

/// Warnings about doubtful results, as sentences for the user.
namespace cloud2csg {

inline void append(std::vector<std::string>& warnings, std::span<const std::string> more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

[[nodiscard]] std::size_t count_of(std::span<const SurfacePoints> primitives);

/// Warns of unexplained points, loss in a merge, and an early stop. `tolerance`: largest distance from a primitive.
[[nodiscard]] std::vector<std::string> fit_warnings(const ExtractStatistics& statistics, double tolerance);

/// @throws Error for a tolerance as large as the cloud
[[nodiscard]] std::vector<std::string> tolerance_warnings(double tolerance, double diagonal);

/// `points`: the number in the raw cloud
[[nodiscard]] std::vector<std::string> outlier_warnings(const CleanReport& report, std::size_t points);

/// @throws Error without surfaces and without points on known primitives
[[nodiscard]] std::vector<std::string> detection_warnings(const RestDetection& found, const PreparedCloud& prepared);

/// Warns of places where a tree over the chosen solids is wrong: see wrong_place_share().
[[nodiscard]] std::vector<std::string> disagreement_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             double disagreement);

/// Warns of parts of the solid's surface without points nearby. @throws Cancelled
[[nodiscard]] std::vector<std::string> bare_surface_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             const RunContext& run);

/// Warns of detected surfaces that are not on the solid, since a part may be too small to be worth a leaf.
[[nodiscard]] std::vector<std::string> unused_surface_warnings(const CsgTree& tree, const FoundPrimitives& found);

/// Warns of known primitives missing from the tree, except those that the warnings in `told` name.
[[nodiscard]] std::vector<std::string> unused_known_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             const PrimitiveSet& known,
                                                             std::span<const std::string> told);

}  // namespace cloud2csg
