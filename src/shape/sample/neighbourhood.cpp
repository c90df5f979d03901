#include "shape/sample/neighbourhood.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cloud2csg/advanced/restrict.hpp"
#include "core/geometry/boxes.hpp"
#include "core/primitive/bounds_index.hpp"

namespace cloud2csg {
namespace {

/// The formula of an expression may be negative outside its bounds.
bool has_known_reach(const Primitive& primitive, const AlignedBox& box) {
  return !std::holds_alternative<Expression>(primitive.shape) && is_finite(box);
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
  const BoundsIndex index(bounded);
  std::vector<std::vector<PrimitiveIndex>> meeting(primitives.size());
  for (const PrimitiveIndex p : far_reaching) meeting[p].assign(used.begin(), used.end());
  for (const auto& [box, p] : bounded) {
    std::vector<PrimitiveIndex>& found = meeting[p];
    found = far_reaching;
    for (auto hit = index.qbegin(boost::geometry::index::intersects(box)); hit != index.qend(); ++hit)
      found.push_back(hit->second);
    std::sort(found.begin(), found.end());
  }
  return meeting;
}

std::vector<Neighbourhood> neighbourhoods(const Model& model, std::span<const PrimitiveIndex> used, double margin) {
  std::vector<std::vector<PrimitiveIndex>> meeting = meeting_bounds(model.primitives, used, margin);
  const TreeRestriction restriction(tree_of(model));
  std::vector<Neighbourhood> result;
  result.reserve(used.size());
  for (const PrimitiveIndex p : used) {
    Neighbourhood& here = result.emplace_back();
    here.members = std::move(meeting[p]);
    for (const PrimitiveIndex member : here.members) here.primitives.push_back(model.primitives[member]);
    here.tree = localised(restriction.restrict_to(here.members), here.members);
  }
  return result;
}

}  // namespace cloud2csg
