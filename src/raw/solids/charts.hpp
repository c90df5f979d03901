#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/geometry.hpp"
#include "raw/solids/choose_faces.hpp"

namespace cloud2csg {

/// A drawing of the surfaces that share a direction, across it (x, y), or of those that share an axis, in the
/// half-plane (r, z). An extrusion or a revolution is a set of its faces.
struct Chart {
  bool is_turned = false;
  Pose frame = {};       ///< local z is the direction or the axis
  Drawing drawing = {};  ///< price_of_edge: the share of the edge, times its length, where no points are
  /// Ends that an extrusion may have: local z, ascending. If turned, angles about local z between -pi and pi at which
  /// sectors may end; they may also end at pi, which is in a gap. None if there are only full turns.
  std::vector<double> caps = {};

  /// (x, y) or (r, z).
  [[nodiscard]] Eigen::Vector2d place_of(const Eigen::Vector3d& point) const;
  /// The height along local z, or the angle about it.
  [[nodiscard]] double level_of(const Eigen::Vector3d& point) const;
};

struct ChartOptions {
  double tolerance = 0;  ///< nearer curves are one, and curves that come nearer touch
  double spacing = 0;    ///< of the cloud's points
  std::size_t most_directions = 12, most_axes = 24;
};

/// Charts of all directions and axes that surfaces have, those with the most points first. Curves reach a little beyond
/// their points. O(frames x surfaces x points of a surface), and arrange() for each chart
[[nodiscard]] std::vector<Chart> make_charts(const Points& positions, std::span<const DetectedSurface> surfaces,
                                             const ChartOptions& options);

}  // namespace cloud2csg
