#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/find_primitives.hpp"

/// Warnings about the work, as sentences for the user. Doubts about the result are in its Verdict.
namespace cloud2csg {

inline void append(std::vector<std::string>& warnings, std::span<const std::string> more) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

/// 0 of nothing.
[[nodiscard]] double share(std::size_t part, std::size_t all);

[[nodiscard]] std::size_t count_of(std::span<const SurfacePoints> primitives);

/// Warns of loss in a merge, and of an early stop.
[[nodiscard]] std::vector<std::string> search_warnings(const ExtractStatistics& statistics);

/// Whether points within the tolerance of a surface say little: parts of a typical size vanish in it.
[[nodiscard]] bool is_coarse(double tolerance, double diagonal);

/// Warns of a given tolerance that is coarse, or less than the noise. @throws Error for one as large as the cloud
[[nodiscard]] std::vector<std::string> tolerance_warnings(double tolerance, const Scale& scale);

/// `origin`: that of the prepared cloud's frame
[[nodiscard]] std::vector<std::string> normals_warnings(const PreparedCloud& prepared, const Eigen::Vector3d& origin);

/// `points`: the number in the raw cloud
[[nodiscard]] std::vector<std::string> outlier_warnings(const CleanReport& report, std::size_t points);

/// Warns of known primitives missing from the tree, except those that the warnings in `told` name.
[[nodiscard]] std::vector<std::string> unused_known_warnings(const CsgTree& tree, const FoundPrimitives& found,
                                                             const PrimitiveSet& known,
                                                             std::span<const std::string> told);

}  // namespace cloud2csg
