#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cloud2csg/geometry.hpp"

/// Unbounded surfaces in a cloud (planes, spheres, cylinders, cones and tori) and their fits to points.
namespace cloud2csg {

enum class SurfaceType { plane, sphere, cylinder, cone, torus };

/// "plane", "sphere", "cylinder", "cone", "torus".
[[nodiscard]] std::string_view type_name(SurfaceType type);

/// An unbounded surface. Members have a meaning only for the types that they name.
/// The tube of a torus may cross the axis; then its outside is the surface. The major radius is below the minor one, as
/// of an apple, or negative, as of a lemon; the sum of both is above 0.
struct Surface {
  SurfaceType type = SurfaceType::plane;
  /// A point of the plane; the centre of a sphere or torus; a point on the axis of a cylinder; the apex of a cone.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Unit length: a plane's outward normal; the axis of a cylinder or torus; a cone's axis from apex into the opening.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius = 0;        ///< sphere, cylinder; torus: major radius, from its axis to the tube's centre
  double half_angle = 0;    ///< cone: angle between axis and surface in radians, above 0 and below pi / 2
  double minor_radius = 0;  ///< torus: radius of the tube
  bool concave = false;     ///< the material is outside, as around a hole; never for planes
};

/// Distance from the surface in the points' units, negative on the material's side. Euclidean, except near the axis of
/// a torus whose tube crosses it. A cone has one nappe: behind the apex it is the distance from the apex. O(1)
[[nodiscard]] double signed_distance(const Surface& surface, const Eigen::Vector3d& point);

/// Gradient of signed_distance(): unit outward normal at the point's foot. On axes and centres, one of the limits.
[[nodiscard]] Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector3d& point);

/// The same at many points, one value each. O(n)
[[nodiscard]] std::vector<double> signed_distance(const Surface& surface, PointsView points);
[[nodiscard]] Points normal(const Surface& surface, PointsView points);

/// What a fit leaves as it is: the direction of the axis or plane, or the line of the axis, of surfaces that have one.
enum class HeldValue { none, direction, axis };

struct FitOptions {
  /// Standard deviation of the points' distances from the surface, in their units. Points beyond about five of it lose
  /// their influence. Those of the right surface must be within about five of the start; if most are not, within 30.
  /// Absent: 1.4826 times the median distance, measured during the fit. That tolerates a worse start and 50 % outliers.
  std::optional<double> noise = {};
  /// A larger set is thinned evenly: takes a few milliseconds, and adds uncertainty far below that of the noise.
  std::size_t most_points = 4000;
  HeldValue held = HeldValue::none;
  /// By point: the noise over the point's own, above 0. A distance counts times this. Empty: all have the same noise.
  std::span<const double> precisions = {};
};

/// Standard deviations of the fitted values; infinite for undetermined values, zero for held ones and those outside of
/// the type.
struct SurfaceUncertainty {
  double position = 0;    ///< worst direction; for cylinders and cones, across the axis at the middle of the points
  double axis = 0;        ///< worst direction, in radians; 0 for spheres
  double radius = 0;      ///< cones: at the middle of the points
  double half_angle = 0;  ///< in radians
  double minor_radius = 0;
};

struct SurfaceFit {
  Surface surface;
  double rms = 0;           ///< root mean square distance of the inliers, each times its precision
  double noise = 0;         ///< noise that the fit used
  std::size_t inliers = 0;  ///< given points within 4.685 times their noise
  SurfaceUncertainty uncertainty = {};
};

/// Fits a surface of the type of `start`, near it, by least squares of Euclidean distances (3, 4, 5, 6 or 7 unknowns
/// for a plane, sphere, cylinder, cone or torus). Uses Tukey's loss (first Huber's, without a noise), by
/// Levenberg-Marquardt. Points are centred and scaled to keep digits. The side of the material stays, and roughly the
/// direction of a cylinder's or torus' axis. The position of a plane or cylinder is its point nearest to the middle of
/// the points. Absent with fewer points than unknowns, or when the fit degenerates (cylinder without radius, flat cone
/// or cone without opening). O(points x iterations): 1 to 5 ms for 4000 points.
/// Preconditions: finite points, start.axis of unit length.
[[nodiscard]] std::optional<SurfaceFit> fit_surface(const Surface& start, std::span<const Eigen::Vector3d> points,
                                                    const FitOptions& options = {});

/// Estimates a surface of the given type from points and their outward normals in closed form, as a start for
/// fit_surface(). The normals tell the side of the material. Plane: principal components. Sphere: linear least squares.
/// Cylinder: the axis across the normals, then a circle. Cone: the apex in all tangent planes. Torus: the axis as the
/// line that all normals meet, or from the plane of its tube's centres, whichever is nearer to the points; then a
/// circle in the half plane around it. There is no robust loss, so it tolerates noise but not many outliers.
/// Absent for too few points, or points that do not determine the surface. O(n).
/// Preconditions: as many normals as points, all finite, the normals of unit length.
[[nodiscard]] std::optional<Surface> estimate_surface(SurfaceType type, std::span<const Eigen::Vector3d> points,
                                                      std::span<const Eigen::Vector3d> normals);

}  // namespace cloud2csg
