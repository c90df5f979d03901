#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "detection/scene.hpp"

/// Which true surfaces were found.
///
/// A found surface matches a true surface if
/// - it has at least two fifths of the true surface's points in the cloud. Those that cleaning left out count, and so
///   do those on no found surface. Half would be too many: beside a step of half of sigma, the true surfaces themselves
///   are nearest to only 60 % of their points, give or take 6 % of 60 points;
/// - it has the same type, and its material on the same side;
/// - at least half of the true surface's places without noise are no farther from it than sigma, with an outward normal
///   to the same side as the true one. A surface off by sigma doubles the mean square distance of the points; the
///   standard error of a fit to 30 points is a third of sigma. Where views are misaligned, it is the deviation of both
///   views' points.
///
/// A question is answered if each of its surfaces can have a matching found surface of its own. So a plane through the
/// middle of a low step, which is near enough to both sides, answers nothing.
namespace cloud2csg::bench {

/// The cloud with the normals of the true surfaces; outliers have arbitrary ones.
[[nodiscard]] PointCloud with_true_normals(const Scene& scene);

using Detector = std::function<std::vector<DetectedSurface>(const PreparedCloud&)>;

/// detect_surfaces() with default options.
[[nodiscard]] std::vector<DetectedSurface> detect_by_default(const PreparedCloud& prepared);

/// prepare_cloud() and the detector. The surfaces have the indices of the given cloud's points. None for a cloud that
/// is refused.
[[nodiscard]] std::vector<DetectedSurface> find_surfaces(const PointCloud& cloud,
                                                         const Detector& detector = detect_by_default);

[[nodiscard]] bool is_answered(const Scene& scene, const Question& question, std::span<const DetectedSurface> found);

/// Found surfaces that match no true one.
[[nodiscard]] std::size_t count_unmatched(const Scene& scene, std::span<const DetectedSurface> found);

}  // namespace cloud2csg::bench
