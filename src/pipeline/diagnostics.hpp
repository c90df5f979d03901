#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/find_primitives.hpp"

/// What is doubtful about a result, and where: sentences for the user.
namespace cloud2csg {

inline void append(std::vector<std::string>& warnings, std::span<const std::string> more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// How many points lie on some primitives.
[[nodiscard]] std::size_t count_of(std::span<const SurfacePoints> primitives);

/// Of an extraction: points that its tree does not explain, a merge that lost something, a search that was stopped.
/// `tolerance`: how far points may be from their primitive.
[[nodiscard]] std::vector<std::string> fit_warnings(const ExtractStatistics& statistics, double tolerance);

/// @throws Error when it is as large as the cloud
[[nodiscard]] std::vector<std::string> tolerance_warnings(double tolerance, double diagonal);

/// @throws Error when there is neither a surface nor a point on what is known
[[nodiscard]] std::vector<std::string> detection_warnings(const RestDetection& found, const PreparedCloud& prepared);

/// Places where a tree over the chosen solids is wrong: see wrong_place_share().
[[nodiscard]] std::vector<std::string> disagreement_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             double disagreement);

/// Parts of the solid's surface that no point is near. @throws Cancelled
[[nodiscard]] std::vector<std::string> bare_surface_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             const RunContext& run);

/// Surfaces that were found and are not on the solid: a part may be too small to be worth a leaf.
[[nodiscard]] std::vector<std::string> unused_surface_warnings(const CsgTree& tree, const FoundPrimitives& found);

/// Known primitives that a tree does without, but those that what was `told` names already.
[[nodiscard]] std::vector<std::string> unused_known_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             const PrimitiveSet& known,
                                                             std::span<const std::string> told);

}  // namespace cloud2csg
