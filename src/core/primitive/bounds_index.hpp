#pragma once

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <utility>

#include "cloud2csg/primitive.hpp"

/// An R-tree over the bounds of primitives.
namespace cloud2csg {

using IndexPoint = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using IndexBox = boost::geometry::model::box<IndexPoint>;
using IndexEntry = std::pair<IndexBox, PrimitiveIndex>;
/// Construction from a range of entries packs the tree: O(n log n).
using BoundsIndex = boost::geometry::index::rtree<IndexEntry, boost::geometry::index::quadratic<16>>;

[[nodiscard]] inline IndexBox to_index_box(const AlignedBox& box, double margin) {
  const auto corner = [margin](const Eigen::Vector3d& p, double sign) {
    return IndexPoint(p.x() + sign * margin, p.y() + sign * margin, p.z() + sign * margin);
  };
  return {corner(box.min(), -1), corner(box.max(), 1)};
}

}  // namespace cloud2csg
