#pragma once

#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// The part of a solid's surface that no point is near, by samples.
struct BareSurface {
  PointCloud samples = {};             ///< with the outward normals of their primitives
  std::vector<double> shares = {};     ///< of the solid's surface, by sample
  std::vector<double> distances = {};  ///< to the nearest point, by sample

  [[nodiscard]] double share() const;
};

/// Surface farther than this from all points has none.
[[nodiscard]] double bare_distance(double spacing, double tolerance);

/// By at least a thousand samples of each primitive, the same for any number of threads. O(points log points + samples
/// x size)
/// @throws Cancelled
[[nodiscard]] BareSurface find_bare_surface(const CsgTree& tree, const PrimitiveSet& solids, const Points& points,
                                            double near, const RunContext& run = {});

/// Places on both sides of a bare surface, labelled as the places around them, where these agree. As beside points, the
/// places beside the whole surface would weigh 1 in total. If the labels of both sides are equal, the solid should not
/// end there.
[[nodiscard]] LabelledPlaces places_beside(const BareSurface& bare, const LabelledPlaces& places, double depth);

}  // namespace cloud2csg
