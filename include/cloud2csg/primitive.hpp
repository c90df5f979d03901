#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cloud2csg/geometry.hpp"

/// Primitives: the solids at the leaves of a CSG tree, as plain values.
///
/// Every solid has a signed distance f (negative inside, positive outside, in the cloud's units), its gradient, and
/// bounds. All shapes are centred at the origin of their local frame, but for the places of profiles; `Primitive::pose`
/// places them in the world.
namespace cloud2csg {

/// Position in a PrimitiveSet: the identity of a primitive everywhere in the library.
using PrimitiveIndex = std::uint32_t;

struct Box {
  Eigen::Vector3d size;  ///< edge lengths
};
struct Sphere {
  double radius;
};
/// Axis = local z, centred: |z| <= height / 2.
struct Cylinder {
  double radius;
  double height;
};
/// A frustum: axis = local z, centred; radius_bottom at z = -height / 2. One of the radii may be 0.
struct Cone {
  double radius_bottom;
  double radius_top;
  double height;
};
/// Axis = local z. minor_radius <= major_radius.
struct Torus {
  double major_radius;
  double minor_radius;
};
/// Local z <= 0.
struct HalfSpace {};
/// normal . x <= offset, normal of unit length.
struct Plane {
  Eigen::Vector3d normal;
  double offset;
};
/// The intersection of the half-spaces of its planes; must be bounded and have volume.
struct Polytope {
  std::vector<Plane> planes;
};
/// The start of a segment of a closed path. The segment ends at the next corner, the last one at the first.
struct PathCorner {
  Eigen::Vector2d point;
  /// 0 for a line; else tan(angle / 4) of an arc that turns left by this angle, as in DXF. 1 and -1 are half circles.
  double bulge = 0;
};
using ClosedPath = std::vector<PathCorner>;
/// A region of the plane: the places inside an odd number of its paths. Paths neither cross nor touch themselves or
/// each other.
struct Profile {
  std::vector<ClosedPath> paths;
};
/// The profile in local (x, y), times |z| <= height / 2.
struct Extrusion {
  Profile profile;
  double height;
};
/// The profile in the half-plane (r, z), r >= 0, turned about local z. It meets the axis in lines with r = 0, which
/// are no surface, or not at all. Below a full turn it is a sector from local +x towards +y.
struct Revolution {
  Profile profile;
  double angle_deg = 360;  ///< above 0, at most 360
};
/// A formula in x, y, z (muParser), negative inside. `bounds` encloses the displaced solid in its local frame.
struct Expression {
  std::string distance;
  AlignedBox bounds;
};

using Shape = std::variant<Box, Sphere, Cylinder, Cone, Torus, HalfSpace, Polytope, Extrusion, Revolution, Expression>;

/// Adds sin(kx) sin(ky) sin(kz), k = frequency, to the distance, in the primitive's local frame.
struct Displacement {
  double frequency;
};

/// How well a cloud supports a primitive: counts the points that lie on its surface and are nearer to no other's.
struct Evidence {
  std::size_t points = 0;
  double rms = 0;  ///< root mean square of the points' distances from the surface, in the cloud's units
};

struct Primitive {
  std::string id;
  Shape shape;
  Pose pose = {};
  std::optional<Displacement> displacement = {};
  /// Present where it was measured. Nothing depends on it: it tells how a primitive was found.
  std::optional<Evidence> evidence = {};
};

using PrimitiveSet = std::vector<Primitive>;

/// As in model files: "box", "sphere", "cylinder", "cone", "torus", "half_space", "polytope", "extrusion",
/// "revolution", "expression".
[[nodiscard]] std::string_view type_name(const Shape& shape);

/// @throws Error (where = "radius", "size"... ) when a parameter is not finite or not positive, a polytope is empty or
/// unbounded, a path of a profile crosses or touches itself or another (the message names both segments), an expression
/// does not parse, or the rms of the evidence is not finite or negative.
void validate(const Primitive& primitive);

/// What the primitive costs a person who edits a tree, in leaves: 1, for a profile 0.1 more for each segment beyond the
/// fourth (a whole circle is one), and for a polytope 0.2 more for each plane beyond the sixth. O(segments)
[[nodiscard]] double price_of(const Primitive& primitive);

/// Whether the primitive is neither an Expression nor displaced. Then its surface has a closed form, its gradient has
/// unit length wherever it exists, and its distance has Lipschitz constant 1.
[[nodiscard]] bool is_plain(const Primitive& primitive);

/// Whether signed_distance() is Euclidean everywhere. True for plain primitives except polytopes, whose distance is
/// only a lower bound outside, near edges and vertices.
[[nodiscard]] bool has_exact_distance(const Primitive& primitive);

/// Whether the solid is convex and undisplaced, so that support() holds.
[[nodiscard]] bool is_convex(const Primitive& primitive);

/// Signed distances at points (world frame), one per point, negative inside. O(points x planes or segments).
[[nodiscard]] std::vector<double> signed_distance(const Primitive& primitive, PointsView points);

/// Gradients of signed_distance at points (world frame), not normalised: unit length where the distance is Euclidean.
/// Analytic, except for expressions (central differences in the local frame, rotated back). Where f is not
/// differentiable (centre of a sphere, edges of a box from inside), it is one of the limits, of unit length.
[[nodiscard]] Points gradient(const Primitive& primitive, PointsView points);

/// Distance and gradient in one pass into the caller's memory; all spans have the size of `points`. Vectorised with the
/// machine's widest instruction set, chosen at run time. Bit for bit equal to signed_distance() and gradient().
template <class Real>
struct BasicFieldSpans {
  std::span<Real> distance, gradient_x, gradient_y, gradient_z;
};
using FieldSpans = BasicFieldSpans<double>;
void evaluate_field(const Primitive& primitive, PointsView points, const FieldSpans& out);

/// Distances only: at least as fast as evaluate_field(), and equal bit for bit to signed_distance().
void evaluate_distance(const Primitive& primitive, PointsView points, std::span<double> out);

/// Distances and gradients in single precision, about twice as fast. The error is a few units in the last place of the
/// largest coordinate, size or distance, so give points in a frame with a near origin. Displaced solids and expressions
/// are evaluated in double precision and rounded. The bits do not depend on the instruction set.
void evaluate_field(const Primitive& primitive, BasicPointsView<float> points, const BasicFieldSpans<float>& out);

/// Axis-aligned bounds of the solid in the world; infinite for half-spaces, not tight for displaced solids.
[[nodiscard]] AlignedBox bounds(const Primitive& primitive);

/// Bounds of all points where signed_distance() is at most `distance` >= 0. Infinite for half-spaces and expressions.
[[nodiscard]] AlignedBox reach(const Primitive& primitive, double distance);

/// Oriented bounds in the primitive's own orientation; infinite for half-spaces, not tight for displaced solids.
[[nodiscard]] OrientedBox oriented_bounds(const Primitive& primitive);

/// The point of a convex solid farthest in `direction` (world frame, any length but zero).
/// Precondition: is_convex() and bounded.
[[nodiscard]] Eigen::Vector3d support(const Primitive& primitive, const Eigen::Vector3d& direction);

/// Corners of a polytope in its local frame, in no particular order. O(planes^4), planes are few.
[[nodiscard]] std::vector<Eigen::Vector3d> corners(const Polytope& polytope);

}  // namespace cloud2csg
