#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg::script {

/// A solid in its place, or the union or intersection of `kept` minus `removed`.
struct Part {
  enum class Kind { solid, united, common };
  Kind kind = Kind::solid;
  Primitive solid = {};            ///< Kind::solid only
  std::vector<Part> kept = {};     ///< in any order
  std::vector<Part> removed = {};  ///< Kind::common only; in any order
};

/// All points x with normal . x = offset.
struct MirrorPlane {
  Eigen::Vector3d normal;  ///< unit length
  double offset;
};

[[nodiscard]] Part moved(const Part& part, const Pose& motion);
[[nodiscard]] Part mirrored(const Part& part, const MirrorPlane& plane);

/// The mean position of the part's solids. It moves with the part.
[[nodiscard]] Eigen::Vector3d centre_of(const Part& part);

[[nodiscard]] std::size_t solid_count(const Part& part);

/// Whether patterns can contain the solid: boxes, spheres, cylinders, cones and tori.
[[nodiscard]] bool can_repeat(const Primitive& primitive);

/// Approximate largest distance between two solids' surfaces; infinite for different or unrepeatable types.
[[nodiscard]] double misfit(const Primitive& a, const Primitive& b);

/// The same for parts of equal structure; infinite if a solid has no counterpart within `tolerance`.
/// O(product of the operands, for each pair of combinations)
[[nodiscard]] double misfit(const Part& a, const Part& b, double tolerance);

/// Whether structure and sizes are equal within `tolerance`, wherever the parts are.
[[nodiscard]] bool are_alike(const Part& a, const Part& b, double tolerance);

}  // namespace cloud2csg::script
