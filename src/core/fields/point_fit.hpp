#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// The owner of a point where the tree takes the value of no primitive: empty, full.
inline constexpr PrimitiveIndex k_no_owner = std::numeric_limits<PrimitiveIndex>::max();

/// Values of a tree at points, one entry a point.
struct PointFit {
  std::vector<double> values = {};  ///< the tree's value: positive outside the solid
  /// The value over the slope of the tree's field: the distance to first order, also of expressions and displaced
  /// solids. Without normals, the value.
  std::vector<double> signed_distances = {};
  std::vector<double> angles = {};          ///< between normal and gradient, radians; empty without normals
  std::vector<PrimitiveIndex> owners = {};  ///< from owners_of(), when asked for
};

struct PointFitOptions {
  std::span<const std::uint32_t> order = {};  ///< the points' order, neighbours together; empty: as they are
  bool with_owners = false;
  double tie = 1e-9;  ///< share of the points' diagonal: values that differ by less count as equal, for owners
};

/// Measures a tree at all points. `noise` tells how near most are to the surface. A large tree is evaluated with its
/// near primitives first, block by block in the given order, which is fast if successive points are near. @throws
/// Cancelled
[[nodiscard]] PointFit measure_points(const Model& model, const PointCloud& cloud, double noise,
                                      const PointFitOptions& options = {}, const RunContext& run = {});

/// The primitive whose value, or its negative, the tree takes at each point; the first of several within `tolerance`,
/// as where surfaces coincide. `values` are the tree's. O(points x primitives of the tree)
[[nodiscard]] std::vector<PrimitiveIndex> owners_of(std::span<const double> values, const CsgTree& tree,
                                                    const PrimitiveSet& primitives, PointsView points,
                                                    double tolerance = 0);

/// Precondition: there are values.
[[nodiscard]] double root_mean_square(std::span<const double> values);
/// The value that 95 % are below. Reorders the values. Precondition: there are values.
[[nodiscard]] double quantile_95(std::vector<double>& values);

}  // namespace cloud2csg
