#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/sample.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

/// Parts whose surfaces are known, for tests of the choice of solids.
namespace cloud2csg::test {

/// A part that is known, and a cloud of it.
struct Part {
  PrimitiveSet solids;
  CsgTree tree;
  PointCloud cloud;
  std::vector<DetectedSurface> surfaces;
};

inline Part part_of(PrimitiveSet solids, const std::string& formula, double noise = 0.002) {
  Part part{.solids = std::move(solids), .tree = {}, .cloud = {}, .surfaces = {}};
  part.tree = parse_tree(formula, part.solids);
  part.cloud =
      sample_surface({.primitives = part.solids, .tree = part.tree}, {.count = 6000, .noise = noise, .seed = 3});
  part.surfaces = known_surfaces(part.solids, part.cloud, std::max(4 * noise, 1e-3));
  return part;
}

/// Few places, so that the tests stay quick.
inline SolidOptions quick() {
  SolidOptions options;
  options.places.volume_places = 6000;
  options.places.surface_points = 2000;
  return options;
}

/// Of the chosen solids with the part, on a lattice.
inline double iou_with(const Part& part, const SolidChoice& choice) {
  PrimitiveSet all = part.solids;
  std::vector<PrimitiveIndex> new_index;
  for (const Primitive& solid : choice.solids) {
    new_index.push_back(static_cast<PrimitiveIndex>(all.size()));
    all.push_back(solid);
  }
  return membership_iou(part.tree, renumber(choice.tree, new_index), all, 50);
}

inline SolidChoice expect_recovered(const Part& part, std::size_t most_leaves) {
  SolidChoice choice = choose_solids(part.cloud, part.surfaces, quick());
  EXPECT_LE(leaf_count(choice.tree), most_leaves) << to_text(choice.tree, choice.solids);
  EXPECT_GE(iou_with(part, choice), 0.99) << to_text(choice.tree, choice.solids);
  for (const Primitive& solid : choice.solids) EXPECT_NO_THROW(validate(solid));
  return choice;
}

inline Primitive turned(Primitive solid, const Eigen::Vector3d& axis, double degrees) {
  solid.pose.orientation = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized());
  return solid;
}

}  // namespace cloud2csg::test
