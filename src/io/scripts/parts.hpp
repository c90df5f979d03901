#pragma once

#include <vector>

#include "cloud2csg/primitive.hpp"

/// Solids, or combinations of some, as those see them who look for what repeats.
namespace cloud2csg::script {

/// A solid in its place; or what all of `kept` unite to, or have in common, less all of `removed`.
struct Part {
  enum class Kind { solid, united, common };
  Kind kind = Kind::solid;
  Primitive solid = {};            ///< Kind::solid only
  std::vector<Part> kept = {};     ///< in any order
  std::vector<Part> removed = {};  ///< Kind::common only; in any order
};

/// All points x of normal . x = offset.
struct MirrorPlane {
  Eigen::Vector3d normal;  ///< of unit length
  double offset;
};

[[nodiscard]] Part moved(const Part& part, const Pose& motion);
[[nodiscard]] Part mirrored(const Part& part, const MirrorPlane& plane);

/// The mean of where its solids are: goes with the part wherever it is moved.
[[nodiscard]] Eigen::Vector3d centre_of(const Part& part);

[[nodiscard]] std::size_t solid_count(const Part& part);

/// Whether all solids are of those that are compared: boxes, spheres, cylinders, cones and tori.
[[nodiscard]] bool can_repeat(const Primitive& primitive);

/// How far the surfaces of two solids are apart at most, about; infinite for solids of different or of other types than
/// those of patterns.
[[nodiscard]] double misfit(const Primitive& a, const Primitive& b);

/// The same of parts whose solids are combined alike; infinite where solids of one have none of the other within
/// `tolerance`. O(product of the operands, of each pair of combinations)
[[nodiscard]] double misfit(const Part& a, const Part& b, double tolerance);

/// Whether solids are combined alike and of the same sizes within `tolerance`, wherever they are.
[[nodiscard]] bool are_alike(const Part& a, const Part& b, double tolerance);

}  // namespace cloud2csg::script
