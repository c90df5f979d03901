#pragma once

#include <cstddef>

#include "detection/scene.hpp"

/// The most powerful test for a question, with 1 % false positives. It knows the true surfaces, the noise, the
/// alternative, and which points are on the tested surfaces: nothing that sees only the points can do better.
///
/// `one_plane`: the heights of the points above the plane are a plane, free in three parameters, plus noise. The test
/// is for adding the true heights. The logarithm of the ratio of likelihoods, each maximised over the free plane, is
/// linear in the heights. So it is normally distributed, and the test is the z test: with t the part of the true
/// heights that no plane explains, in sigma, z = heights * t / |t| has the mean |t| if the surfaces are there, else 0.
///
/// The others: let m be 1, 2 or 3 coordinates across the middle plane, the axis, or around the centre, in sigma, rho
/// their length, and r the distance of the surface from the middle. Points on all sides of the middle with noise have
/// the density of the normal distribution N(0, 1) times exp(-r^2 / 2) A(rho r), where A is the mean of exp(rho r u)
/// over the first coordinate u of the unit vectors: cosh, the Bessel function I0, or sinh(x) / x. The alternative is
/// N(0, 1 + r^2 / m). The logarithms of the ratios of the two densities are summed over the points, and 2000 clouds
/// drawn from the alternative tell which sum has a chance of 1 %.
namespace cloud2csg::bench {

/// Statistic of the test; the oracle detects the surfaces if it is above the threshold.
[[nodiscard]] double oracle_statistic(const Scene& scene, const Question& question);

/// Depends on the scene only by the size of the surfaces, the noise and the number of points: it is the same for all
/// seeds. Precondition: equal noise at all points of the tested surfaces, unless the alternative is `one_plane`.
[[nodiscard]] double oracle_threshold(const Scene& scene, const Question& question);

}  // namespace cloud2csg::bench
