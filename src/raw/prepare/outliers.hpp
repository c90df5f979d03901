#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "raw/prepare/local_fit.hpp"

namespace cloud2csg {

/// In a cloud without outliers even odd points, as at corners of sparse parts, are on a surface; where there are many
/// outliers, those that are far from others, or among points without planes, have to prove more.
enum class Strictness : std::uint8_t { trusting, suspicious };

enum class Verdict : std::uint8_t { stays, isolated, off_surface };

/// Which points lie on a surface: through them go enough of the planes of their neighbours. By entry of the fits.
/// O(n) @throws Cancelled
[[nodiscard]] std::vector<Verdict> judge_points(const LocalFits& fits, const Scale& scale, Strictness strictness,
                                                const RunContext& run, const StageShare& share);

/// Neighbours whose planes judge a point.
constexpr std::size_t k_judges = 24;
/// Of a cleaning pass: one that leaves out less than this share of the points changes nothing that matters.
constexpr double k_settled = 0.005;

}  // namespace cloud2csg
