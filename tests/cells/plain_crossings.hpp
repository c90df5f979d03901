#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
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
  std::vector<PrimitiveIndex> on = {};  ///< the primitives on whose surface it may be
  bool is_open = false;                 ///< too near to another surface
  bool is_unsure = false;               ///< near another surface
};

inline PlainPoint plain_point(const std::vector<PlainField>& fields, std::size_t i, const Eigen::Vector3d& normal,
                              const SegmentationTolerances& tolerances) {
  PlainPoint point;
  const auto dot_of = [&](PrimitiveIndex p) {
    const Eigen::Vector3d slope = fields[p].slopes[i];
    return slope.x() * normal.x() + slope.y() * normal.y() + slope.z() * normal.z();
  };
  double least = std::numeric_limits<double>::max();
  for (PrimitiveIndex p = 0; p < fields.size(); ++p) {
    const Eigen::Vector3d slope = fields[p].slopes[i];
    const double dot = dot_of(p);
    const double square = slope.x() * slope.x() + slope.y() * slope.y() + slope.z() * slope.z();
    const double distance = std::abs(fields[p].distances[i]);
    const bool agrees = dot != 0 && dot * dot >= tolerances.cosine * tolerances.cosine * square;
    if (distance > tolerances.distance || !agrees) continue;
    point.on.push_back(p);
    least = std::min(least, distance);
  }
  // Of several surfaces it is on the nearest, and on those that coincide with it.
  const double farthest = least + k_open_share * tolerances.distance;
  for (PrimitiveIndex p = 0; p < fields.size(); ++p) {
    const double distance = fields[p].distances[i];
    const double dot = dot_of(p);
    const bool is_on = std::ranges::count(point.on, p) > 0 && std::abs(distance) <= farthest;
    if (std::abs(distance) <= tolerances.distance && !is_on) point.is_unsure = true;
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
inline PlainCrossings plain(std::span<const Crossings> shares) {
  PlainCrossings result;
  result.points_of_primitive.resize(shares.front().points_of_primitive.size());
  for (const Crossings& share : shares) {
    for (std::size_t p = 0; p < share.points_of_primitive.size(); ++p) {
      result.points_of_primitive[p] += share.points_of_primitive[p];
    }
    result.unassigned += share.unassigned;
    for (const auto& [pair, units] : share.units) {
      result.units[{share.cells[Crossings::inner(pair)], share.cells[Crossings::outer(pair)]}] += units;
    }
  }
  return result;
}

}  // namespace cloud2csg::test
