#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cells/crossings.hpp"
#include "cells/side_kernels.hpp"

/// What points say of cells, straight from the definition: each point is held against each primitive.
namespace cloud2csg::test {

struct PlainCrossings {
  std::map<std::pair<Cell, Cell>, std::uint64_t> units;  ///< by (inner, outer)
  std::vector<std::size_t> points_of_primitive;
  std::size_t unassigned = 0;

  friend bool operator==(const PlainCrossings&, const PlainCrossings&) = default;
};

/// A primitive's field at all points.
struct PlainField {
  std::vector<double> distances;
  Points slopes;
};

/// What one point says.
struct PlainPoint {
  Cell inner = {}, outer = {};
  std::vector<PrimitiveIndex> on = {};  ///< the primitives on whose surface it is
  bool is_open = false;                 ///< too near to another surface
  bool is_unsure = false;               ///< near another surface
};

inline PlainPoint plain_point(const std::vector<PlainField>& fields, std::size_t i, const Eigen::Vector3d& normal,
                              const SegmentationTolerances& tolerances) {
  PlainPoint point;
  for (PrimitiveIndex p = 0; p < fields.size(); ++p) {
    const double distance = fields[p].distances[i];
    const Eigen::Vector3d slope = fields[p].slopes[i];
    const double dot = slope.x() * normal.x() + slope.y() * normal.y() + slope.z() * normal.z();
    const double square = slope.x() * slope.x() + slope.y() * slope.y() + slope.z() * slope.z();
    const bool is_near = std::abs(distance) <= tolerances.distance;
    const bool is_on = is_near && dot != 0 && dot * dot >= tolerances.cosine * tolerances.cosine * square;
    if (is_on) point.on.push_back(p);
    if (is_near && !is_on) point.is_unsure = true;
    if (!is_on && std::abs(distance) <= tolerances.distance * k_open_share) point.is_open = true;
    if (is_on ? dot > 0 : distance < 0) point.inner.push_back(p);
    if (is_on ? dot < 0 : distance < 0) point.outer.push_back(p);
  }
  return point;
}

inline PlainCrossings plain_crossings(const PointCloud& cloud, const PrimitiveSet& primitives,
                                      const SegmentationTolerances& tolerances) {
  std::vector<PlainField> fields;
  for (const Primitive& primitive : primitives) {
    fields.push_back({signed_distance(primitive, cloud.positions), gradient(primitive, cloud.positions)});
  }
  PlainCrossings result;
  result.points_of_primitive.resize(primitives.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const PlainPoint point = plain_point(fields, i, cloud.normals[i], tolerances);
    for (const PrimitiveIndex p : point.on) ++result.points_of_primitive[p];
    if (point.on.empty()) {
      ++result.unassigned;
    } else if (!point.is_open) {
      result.units[{point.inner, point.outer}] += point.is_unsure ? 1 : k_sure_units;
    }
  }
  return result;
}

/// The same form of what was counted fast.
inline PlainCrossings plain(const Crossings& crossings) {
  PlainCrossings result{
      .units = {}, .points_of_primitive = crossings.points_of_primitive, .unassigned = crossings.unassigned};
  for (const auto& [pair, units] : crossings.units) {
    result.units[{crossings.cells[Crossings::inner(pair)], crossings.cells[Crossings::outer(pair)]}] += units;
  }
  return result;
}

}  // namespace cloud2csg::test
