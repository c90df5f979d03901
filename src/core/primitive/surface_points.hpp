#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/base/random.hpp"
#include "core/primitive/profile.hpp"

namespace cloud2csg {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Draws indices with probabilities in proportion to weights.
class WeightedChoice {
 public:
  explicit WeightedChoice(std::span<const double> weights);

  /// Precondition: total() > 0. O(log weights)
  [[nodiscard]] std::size_t draw(RandomStream& random) const;
  [[nodiscard]] double total() const { return sums_.empty() ? 0.0 : sums_.back(); }

 private:
  std::vector<double> sums_;
};

/// Draws points from triangles, uniformly by area.
class TriangleSampler {
 public:
  explicit TriangleSampler(std::vector<Triangle> triangles);
  /// Samples a mesh. `corners` are indices of `vertices`.
  TriangleSampler(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners);

  struct Draw {
    Eigen::Vector3d position;
    std::size_t triangle;
  };
  /// Precondition: area() > 0. O(log triangles)
  [[nodiscard]] Draw draw(RandomStream& random) const;

  [[nodiscard]] double area() const { return choice_.total(); }
  /// By the winding. Zero for a triangle without area, which is never drawn.
  [[nodiscard]] Eigen::Vector3d normal(std::size_t triangle) const;

 private:
  std::vector<Triangle> triangles_;
  WeightedChoice choice_;
};

/// A point on a primitive's own surface and the primitive's outward normal there, in the world.
struct SurfacePoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

/// The surface of a primitive, to draw points from, uniformly by area.
struct PrimitiveSurface {
  double area = 0.0;  ///< 0 when no part of it lies in the region
  std::function<SurfacePoint(RandomStream&)> draw = {};
  /// Upper bound of the drawn points' distance from the surface. If not 0, move them by move_onto_surface().
  double reach = 0.0;
};

/// The faces as fans, counter-clockwise seen from outside.
[[nodiscard]] std::vector<Triangle> triangles_of(const Polytope& polytope);

[[nodiscard]] PrimitiveSurface surface_of(std::vector<Triangle> triangles);

/// The surface that segments in the half-plane (r, z), r >= 0, sweep about z between two angles in radians.
[[nodiscard]] PrimitiveSurface turned_surface(std::vector<ProfileSegment> segments, double from, double to);

/// A flat end of a swept profile: where the plane of the profile is in space.
struct ProfileCap {
  Eigen::Vector3d origin, x_axis, y_axis;
  Eigen::Vector3d normal;  ///< outward
};

/// Two, or none of a full turn.
[[nodiscard]] std::vector<ProfileCap> caps_of(const Extrusion& extrusion);
[[nodiscard]] std::vector<ProfileCap> caps_of(const Revolution& revolution);

/// The part of a cap within a box in the plane of the profile, by the profile's segments and the part's area.
[[nodiscard]] PrimitiveSurface cap_surface(const ProfileCap& cap, std::vector<ProfileSegment> segments,
                                           const Eigen::AlignedBox2d& box, double area);

/// All parts, whose reach must be 0. O(log parts) a point.
[[nodiscard]] PrimitiveSurface joined(std::vector<PrimitiveSurface> parts);

/// The surface of a primitive whose own frame has this pose. `local` is in that frame; its reach must be 0.
[[nodiscard]] PrimitiveSurface placed(PrimitiveSurface local, const Pose& pose);

/// The surface of the shape without its displacement, in closed form. A half-space gives the part of its plane around
/// `region` (finite). Expressions have no area.
[[nodiscard]] PrimitiveSurface make_plain_surface(const Primitive& primitive, const AlignedBox& region);

}  // namespace cloud2csg
