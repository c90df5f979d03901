#pragma once

#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// The free points that lie together and the taken points beside them, with normals estimated among these alone. In a
/// band between two faces that is a few points wide, the other normals follow the faces; the taken points are those of
/// its edges. `index` refers to the points of the whole cloud. `noise` is the standard deviation of the points, and
/// `neighbours` are those in the whole cloud. O(n log n) @throws Cancelled
[[nodiscard]] WorkCloud unexplained_part(const FreePoints& points, const NeighbourTable& neighbours, double noise,
                                         const RunContext& run);

/// The normal that a point had before it took that of a surface.
struct OwnNormal {
  std::uint32_t point;
  Eigen::Vector3d normal;
};

/// Gives a free point the normal of the one surface that it and most of its neighbours lie within reach of, if one of
/// these is a point of that surface. Its own normal, an average over its neighbours, may be arbitrary where these are
/// all around a narrow bore. Points on several surfaces are at an edge, or in a thin wall: they keep theirs. Returns
/// the normals of the points that it turned. O(free points x surfaces + points)
std::vector<OwnNormal> turn_normals(WorkCloud& cloud, const std::vector<GrownSurface>& surfaces,
                                    const NeighbourTable& neighbours);

/// Gives those of the points that are on no surface their own normals back. O(points)
void turn_back(WorkCloud& cloud, const std::vector<OwnNormal>& normals, const std::vector<GrownSurface>& surfaces);

}  // namespace cloud2csg
