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
/// Every solid is given by its signed distance f (negative inside, positive outside, in the cloud's
/// units), the gradient of f and bounds. All shapes are centred at the origin of their own frame;
/// `Primitive::pose` places them in the world.
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
/// A formula in x, y, z (muParser syntax), negative inside; `bounds` encloses the solid, with its displacement if it
/// has one, in its own frame.
struct Expression {
  std::string distance;
  AlignedBox bounds;
};

using Shape = std::variant<Box, Sphere, Cylinder, Cone, Torus, HalfSpace, Polytope, Expression>;

/// Adds sin(kx) sin(ky) sin(kz), k = frequency, to the distance, in the primitive's own frame.
struct Displacement {
  double frequency;
};

/// What a cloud says of a primitive: of the points that lie on its surface and are nearer to no other's.
struct Evidence {
  std::size_t points = 0;
  double rms = 0;  ///< of their distances from the surface, in the cloud's units
};

struct Primitive {
  std::string id;
  Shape shape;
  Pose pose = {};
  std::optional<Displacement> displacement = {};
  /// Where it was measured. It says how a primitive was found, not what it is: nothing depends on it.
  std::optional<Evidence> evidence = {};
};

using PrimitiveSet = std::vector<Primitive>;

/// The type's name as in model files: "box", "sphere", "cylinder", "cone", "torus", "half_space",
/// "polytope", "expression".
[[nodiscard]] std::string_view type_name(const Shape& shape);

/// @throws Error (where = "radius", "size"... ) when a parameter is not finite, not positive, a polytope is
/// empty or unbounded, an expression does not parse, the rms of the evidence is not finite or negative.
void validate(const Primitive& primitive);

/// Whether it is neither an Expression nor displaced. Then its field has a gradient of length one wherever it has one,
/// so that the distance changes by no more than one moves, and its surface has a closed form.
[[nodiscard]] bool is_plain(const Primitive& primitive);

/// Whether signed_distance() is the Euclidean distance to the surface everywhere: true for what is plain, but for
/// polytopes, whose distance is exact inside and a lower bound outside, near edges and vertices.
[[nodiscard]] bool has_exact_distance(const Primitive& primitive);

/// Whether the solid is convex and undisplaced, so that support() holds.
[[nodiscard]] bool is_convex(const Primitive& primitive);

/// Signed distances at points (world frame), one per point, negative inside. O(points x planes).
[[nodiscard]] std::vector<double> signed_distance(const Primitive& primitive, PointsView points);

/// Gradients of signed_distance at points (world frame), not normalised: of unit length where the distance
/// is Euclidean. Analytic, but for expressions (central differences in the local frame, rotated back).
/// Where f is not differentiable (centre of a sphere, edges of a box from inside), one of the limits, of unit length.
[[nodiscard]] Points gradient(const Primitive& primitive, PointsView points);

/// Distance and gradient in one pass into the caller's memory; all spans have the size of `points`. This is the
/// fast path: vectorised, picks the widest instruction set of the machine at run time. Bit for bit equal to
/// signed_distance() and gradient().
template <class Real>
struct BasicFieldSpans {
  std::span<Real> distance, gradient_x, gradient_y, gradient_z;
};
using FieldSpans = BasicFieldSpans<double>;
void evaluate_field(const Primitive& primitive, PointsView points, const FieldSpans& out);

/// Distances only, into the caller's memory: as fast as evaluate_field() or faster, bit for bit equal to
/// signed_distance().
void evaluate_distance(const Primitive& primitive, PointsView points, std::span<double> out);

/// Distances and gradients in single precision, about twice as fast: good to a few units in the last place of the
/// largest of the coordinates, sizes and distances. Points should be given in a frame whose origin is near. Displaced
/// solids and expressions are evaluated in double precision and rounded. The same bits on every instruction set.
void evaluate_field(const Primitive& primitive, BasicPointsView<float> points, const BasicFieldSpans<float>& out);

/// Axis-aligned bounds of the solid in the world; infinite for half-spaces. For displaced solids: enclosing.
[[nodiscard]] AlignedBox bounds(const Primitive& primitive);

/// Bounds of all points where signed_distance() is at most `distance` >= 0; infinite for half-spaces and expressions,
/// whose formulas say nothing of how fast they grow.
[[nodiscard]] AlignedBox reach(const Primitive& primitive, double distance);

/// Oriented bounds, in the primitive's own orientation; infinite for half-spaces. Displaced solids: enclosing.
[[nodiscard]] OrientedBox oriented_bounds(const Primitive& primitive);

/// The point of a convex solid farthest in `direction` (world frame, any length but zero).
/// Precondition: is_convex() and bounded.
[[nodiscard]] Eigen::Vector3d support(const Primitive& primitive, const Eigen::Vector3d& direction);

/// Corners of a polytope in its own frame, in no particular order. O(planes^4), planes are few.
[[nodiscard]] std::vector<Eigen::Vector3d> corners(const Polytope& polytope);

}  // namespace cloud2csg
