#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "raw/prepare/local_fit.hpp"

namespace cloud2csg {

/// `trusting`, for a cloud without outliers, keeps even odd points, such as corners of sparse parts. `suspicious`, for
/// a cloud with many, demands more from points with large gaps or among points without planes.
enum class Strictness : std::uint8_t { trusting, suspicious };

enum class PointFate : std::uint8_t { stays, isolated, off_surface };

/// Judges by how many neighbours' planes contain each point. Indexed by entry of the fits. O(n) @throws Cancelled
[[nodiscard]] std::vector<PointFate> judge_points(const LocalFits& fits, const Scale& scale, Strictness strictness,
                                                  const RunContext& run, const StageShare& share);

/// Whether each point of the cloud is as densely surrounded as most points of surfaces. O(n)
[[nodiscard]] std::vector<bool> dense_points(const LocalFits& fits, const Scale& scale);

/// What the fates leave of a cloud, as indices into it. A doubted point is on none of its neighbours' planes, but
/// dense. The points of a small bore look like this, and so does an outlier beside a face; only surfaces can tell.
struct KeptPoints {
  std::vector<std::uint32_t> sure, doubted;   ///< ascending
  std::size_t isolated = 0, off_surface = 0;  ///< left out
};
[[nodiscard]] KeptPoints kept_points(std::span<const PointFate> fates, const LocalFits& fits,
                                     const std::function<bool(std::uint32_t point)>& is_dense);

/// The sure and the doubted ones, ascending. O(n)
[[nodiscard]] std::vector<std::uint32_t> both(const KeptPoints& kept);

/// The places of those of `some` that are in `all`. Both ascend. O(some log all)
[[nodiscard]] std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> all,
                                                   std::span<const std::uint32_t> some);

}  // namespace cloud2csg
