#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "raw/prepare/local_fit.hpp"

namespace cloud2csg {

/// `trusting`, for a cloud without outliers, keeps even odd points, such as corners of sparse parts. `suspicious`, for
/// a cloud with many, demands more from points with large gaps or among points without planes.
enum class Strictness : std::uint8_t { trusting, suspicious };

enum class Verdict : std::uint8_t { stays, isolated, off_surface };

/// Judges by how many neighbours' planes contain each point. Indexed by entry of the fits. O(n) @throws Cancelled
[[nodiscard]] std::vector<Verdict> judge_points(const LocalFits& fits, const Scale& scale, Strictness strictness,
                                                const RunContext& run, const StageShare& share);

/// Neighbours whose planes judge a point.
constexpr std::size_t k_judges = 24;
/// A cleaning pass that removes a smaller share of the points is negligible.
constexpr double k_settled = 0.005;

}  // namespace cloud2csg
