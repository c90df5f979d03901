#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cloud2csg/geometry.hpp"

/// Surfaces without ends, as they are found in a cloud: planes, spheres, cylinders, cones and tori, and their fits to
/// points.
namespace cloud2csg {

enum class SurfaceType { plane, sphere, cylinder, cone, torus };

/// "plane", "sphere", "cylinder", "cone", "torus".
[[nodiscard]] std::string_view type_name(SurfaceType type);

/// A surface without ends. Members that a type does not name have no meaning for it.
struct Surface {
  SurfaceType type = SurfaceType::plane;
  /// A point of the plane; the centre of a sphere or torus; a point on the axis of a cylinder; the apex of a cone.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  /// Unit length. A plane's outward normal; the axis of a cylinder or torus, either way round; of a cone, from the apex
  /// into the opening. No meaning for a sphere.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius = 0;        ///< of a sphere or cylinder; a torus' major radius, from its centre to the tube's
  double half_angle = 0;    ///< of a cone, in radians, between axis and surface: above 0 and below pi / 2
  double minor_radius = 0;  ///< of a torus: its tube's
  bool concave = false;     ///< the material is outside, as around a hole; never for planes
};

/// Distance from the surface, negative on the material's side, in the points' units: Euclidean, except within a torus
/// whose tube overlaps itself. A cone has one nappe: behind the apex it is the distance from the apex. O(1)
[[nodiscard]] double signed_distance(const Surface& surface, const Eigen::Vector3d& point);

/// The gradient of signed_distance(): the outward normal of the surface at the point's foot, of unit length. Where
/// there is none (on the axis, in the centre) one of the limits.
[[nodiscard]] Eigen::Vector3d normal(const Surface& surface, const Eigen::Vector3d& point);

/// The same at many points, one for each. O(n)
[[nodiscard]] std::vector<double> signed_distance(const Surface& surface, PointsView points);
[[nodiscard]] Points normal(const Surface& surface, PointsView points);

struct FitOptions {
  /// The standard deviation of the points' distances from the surface, in their units: points beyond some five of it
  /// lose their say, however many they are; those of the right surface must lie within some thirty of the start.
  /// Absent: 1.4826 times the median distance, measured along the way, which bears with a poorer start and with
  /// outliers as long as they are fewer than half of the points.
  std::optional<double> noise = {};
  /// Of more points, this many are taken, evenly over their order: what they leave uncertain is far below what the
  /// noise does, and the fit takes a few milliseconds.
  std::size_t most_points = 4000;
};

/// Standard deviations of what was fitted, from the points' residuals and how well they determine each value; infinite
/// where they do not. Zero for what a type does not have.
struct SurfaceUncertainty {
  double position = 0;  ///< in its worst direction, across the axis of a cylinder or cone, at the middle of the points
  double axis = 0;      ///< in its worst direction, in radians; 0 for spheres
  double radius = 0;    ///< of a cone: at the middle of the points
  double half_angle = 0;  ///< in radians
  double minor_radius = 0;
};

struct SurfaceFit {
  Surface surface;
  double rms = 0;           ///< of the distances of the inliers
  double noise = 0;         ///< the standard deviation that the fit took for the points' noise
  std::size_t inliers = 0;  ///< points, of all that were given, within 4.685 times the noise
  SurfaceUncertainty uncertainty = {};
};

/// The surface of the same type near `start` that is nearest to the points: least squares of Euclidean distances (of a
/// plane, sphere, cylinder, cone or torus with 3, 4, 5, 6 or 7 unknowns), first under Huber's loss, then under Tukey's,
/// by Levenberg-Marquardt. Centred and scaled, so that neither large coordinates nor small parts lose digits. Which
/// side the material is on is kept, and so is roughly the direction of a cylinder's or torus' axis. A plane's or
/// cylinder's position is its point nearest to the middle of the points.
/// Absent where there are fewer points than unknowns, or these lead to no such surface: a cylinder of no radius, a cone
/// that is flat or has no opening. O(points x iterations): 1 to 5 ms for 4000 points.
/// Preconditions: finite points, start.axis of unit length.
[[nodiscard]] std::optional<SurfaceFit> fit_surface(const Surface& start, std::span<const Eigen::Vector3d> points,
                                                    const FitOptions& options = {});

/// A surface of the given type from points and their outward normals, in closed form, to start fit_surface() from; also
/// tells from the normals which side the material is on. A plane by principal components; a sphere by linear least
/// squares; a cylinder's axis across the normals, then a circle; a cone's apex in all tangent planes; a torus' axis as
/// the line that all normals meet, or from the plane in which the middles of its tube lie, whichever is nearer to the
/// points, then a circle in the half plane around it. Squares, without a robust loss: bears with noise, not with many
/// outliers.
/// Absent where there are too few points or they do not determine such a surface. O(n).
/// Preconditions: as many normals as points, all finite, the normals of unit length.
[[nodiscard]] std::optional<Surface> estimate_surface(SurfaceType type, std::span<const Eigen::Vector3d> points,
                                                      std::span<const Eigen::Vector3d> normals);

}  // namespace cloud2csg
