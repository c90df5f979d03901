#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raw/detect/agreement.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// Splits the points with these indices into groups that hang together: points belong together when they lie in the
/// same cube of this edge, or in cubes that touch. The largest group first. O(n log n)
[[nodiscard]] std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const OrientedPoint> points,
                                                                       std::span<const std::uint32_t> indices,
                                                                       double edge);

struct SearchLimits {
  AgreementLimits agreement;
  double link;               ///< points of a surface hang together by steps of this length
  std::size_t least_points;  ///< of a surface
};

/// A surface with its points, as indices into the WorkCloud, ascending.
struct GrownSurface {
  Surface surface;
  std::vector<std::uint32_t> points;
  double support = 0;  ///< see support_of()
};

/// How much a type is preferred: a simpler one wins over a more flexible one that explains a few points more.
[[nodiscard]] double preference(SurfaceType type);

/// Takes the points that agree with the surface and hang together, fits it to these, and again, as long as they become
/// more. Absent when they are fewer than the least. O(free points)
[[nodiscard]] std::optional<GrownSurface> grow_surface(const Surface& start, const FreePoints& points,
                                                       const SearchLimits& limits);

/// A cone or torus that the surface is a strip of, when that explains more. Locally nothing tells a slender cone from a
/// cylinder.
[[nodiscard]] GrownSurface with_widest_type(GrownSurface grown, const FreePoints& points, const SearchLimits& limits);

/// The same points as a surface of a simpler type, when that explains nearly as many.
[[nodiscard]] GrownSurface with_simplest_type(GrownSurface grown, const FreePoints& points, const SearchLimits& limits);

}  // namespace cloud2csg
