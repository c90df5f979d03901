#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "core/primitive/profile.hpp"

namespace cloud2csg {

/// Whether a profile may contain a place or not without a difference.
using IsFree = std::function<bool(const Eigen::Vector2d&)>;

/// Where the boxes of other solids begin and end along a solid's own axes.
using Levels = std::array<std::vector<double>, 3>;

/// Positions in an interval, at most `step` apart, with one between any two levels: thin layers are not missed.
[[nodiscard]] std::vector<double> positions_between(double low, double high, const std::vector<double>& levels,
                                                    double step);

/// Shares of the most overshoot, the first of which is taken that is free.
inline constexpr std::array k_overshoot_shares{1.0, 0.5, 0.25, 0.125};
/// Probes across the strip between an old and a new surface.
inline constexpr int k_probes_across = 4;

/// The profile with those segments up to `most` farther out that have only free places beside them, in the order of
/// regions_of(); absent if there are none. O(segments) calls of `is_free` for each `most` of a segment's length
[[nodiscard]] std::optional<Profile> with_free_segments_out(const Profile& outline, bool is_turned, double most,
                                                            const Levels& levels, const IsFree& is_free);

}  // namespace cloud2csg
