#pragma once

#include <cstddef>

namespace cloud2csg {

// Numbers that several steps of preparation and detection share. `bench/constants.py` halves and doubles each.

/// Points a task in parallel loops, and a box in searches. Only speed depends on it.
constexpr std::size_t k_chunk_points = 64;
/// Nearest points that measure spacing and area at a point. A patch, a leaf of a tree or evidence of any kind has at
/// least as many points.
constexpr std::size_t k_nearest = 8;
/// Neighbours that vote on a point, such as on the sign of its normal.
constexpr std::size_t k_voters = 12;
/// Neighbours that a local plane or a proposal is fitted to, and whose planes judge a point.
constexpr std::size_t k_around = 16;
/// Points of a patch: successive ones, so near each other. Their mean shows a low step, and their scatter the noise of
/// the place.
constexpr std::size_t k_patch = 32;
/// Points for a share, whose standard error is at most 2.2 % then, for a median or for a first fit.
constexpr std::size_t k_sample = 512;
/// The same where more precision is worth its time, as for final fits.
constexpr std::size_t k_large_sample = 4096;
/// Best candidates that are looked at thoroughly.
constexpr std::size_t k_best = 8;
/// Repetitions of a step that settles or succeeds quickly, or else will not.
constexpr int k_rounds = 4;
/// Of normally distributed points, 1 in 370 is more standard deviations off its surface.
constexpr double k_deviations = 3;
/// Tolerance relative to distance: the bend of a sphere ten times as large as the neighbourhood.
constexpr double k_bend_tolerance = 0.05;
/// A point whose neighbours are farther than this many spacings is isolated.
constexpr double k_isolated_spacings = 6;
/// Gaps that differ by more are not those of one surface.
constexpr double k_wide_gap = 1.4;
/// Group radii beyond which moments approximate a group of dipoles. Above the 2 of Barill et al. (2018), as there are
/// no third moments, or only the first ones.
constexpr double k_far_radii = 2.5;
/// Cosine of two normals that are alike: of one smooth surface, or, with opposite signs, of the sides of a wall.
constexpr double k_alike_cosine = 0.8;
/// Least cosine of a point's estimated normal and that of its surface: near an edge, such normals are between those of
/// its faces, 45 degrees off both, give or take their noise.
constexpr double k_edge_cosine = 0.5;
/// Sine of a line's angle to a surface (14 degrees) that is no error of the surface's normal.
constexpr double k_steep_sine = 0.25;
/// A clear majority; and a figure below this share of another is clearly less.
constexpr double k_clear_share = 0.7;
constexpr double k_nearly_all = 0.9;
/// A share of the points that does not count.
constexpr double k_negligible_share = 0.005;

}  // namespace cloud2csg
