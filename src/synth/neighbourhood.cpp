#include "synth/neighbourhood.hpp"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <utility>

#include "cloud2csg/restrict.hpp"

namespace cloud2csg {
namespace {

namespace bg = boost::geometry;
using IndexPoint = bg::model::point<double, 3, bg::cs::cartesian>;
using IndexBox = bg::model::box<IndexPoint>;
using IndexEntry = std::pair<IndexBox, PrimitiveIndex>;
using SpatialIndex = bg::index::rtree<IndexEntry, bg::index::quadratic<16>>;

/// Of an expression, the formula may be negative outside of the bounds that it is given.
bool has_known_reach(const Primitive& primitive, const AlignedBox& box) {
  return !std::holds_alternative<Expression>(primitive.shape) && box.min().allFinite() && box.max().allFinite();
}

IndexBox to_index_box(const AlignedBox& box, double margin) {
  const auto corner = [margin](const Eigen::Vector3d& p, double sign) {
    return IndexPoint(p.x() + sign * margin, p.y() + sign * margin, p.z() + sign * margin);
  };
  return {corner(box.min(), -1), corner(box.max(), 1)};
}

}  // namespace

std::vector<std::vector<PrimitiveIndex>> meeting_bounds(const PrimitiveSet& primitives,
                                                        std::span<const PrimitiveIndex> used, double margin) {
  std::vector<IndexEntry> bounded;
  std::vector<PrimitiveIndex> far_reaching;
  for (const PrimitiveIndex p : used) {
    const AlignedBox box = bounds(primitives[p]);
    if (has_known_reach(primitives[p], box)) {
      bounded.emplace_back(to_index_box(box, margin), p);
    } else {
      far_reaching.push_back(p);
    }
  }
  const SpatialIndex index(bounded);
  std::vector<std::vector<PrimitiveIndex>> meeting(primitives.size());
  for (const PrimitiveIndex p : far_reaching) meeting[p].assign(used.begin(), used.end());
  for (const auto& [box, p] : bounded) {
    std::vector<PrimitiveIndex>& found = meeting[p];
    found = far_reaching;
    for (auto hit = index.qbegin(bg::index::intersects(box)); hit != index.qend(); ++hit) found.push_back(hit->second);
    std::sort(found.begin(), found.end());
  }
  return meeting;
}

std::vector<Neighbourhood> neighbourhoods(const CsgTree& tree, const PrimitiveSet& primitives,
                                          std::span<const PrimitiveIndex> used, double margin) {
  std::vector<std::vector<PrimitiveIndex>> meeting = meeting_bounds(primitives, used, margin);
  const TreeRestriction restriction(tree);
  std::vector<PrimitiveIndex> local(primitives.size());
  std::vector<Neighbourhood> result;
  result.reserve(used.size());
  for (const PrimitiveIndex p : used) {
    Neighbourhood& here = result.emplace_back();
    here.members = std::move(meeting[p]);
    for (std::size_t i = 0; i < here.members.size(); ++i) {
      local[here.members[i]] = static_cast<PrimitiveIndex>(i);
      here.primitives.push_back(primitives[here.members[i]]);
    }
    here.tree = renumber(restriction.restrict_to(here.members), local);
  }
  return result;
}

}  // namespace cloud2csg
