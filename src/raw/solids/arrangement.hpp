#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/primitive/profile.hpp"

namespace cloud2csg {

/// The share of a segment's length at which a point on it is; outside [0, 1] beyond its ends. O(1)
[[nodiscard]] double share_of(const ProfileSegment& segment, const Eigen::Vector2d& point);

/// The faces into which pieces of lines and circles divide the plane.
struct CurveArrangement {
  struct Edge {
    ProfileSegment segment;  ///< from the start vertex to the end vertex
    std::uint32_t start, end;
    std::uint32_t piece;        ///< that it is a part of
    std::uint32_t left, right;  ///< the faces beside it
  };
  std::vector<Eigen::Vector2d> vertices;
  std::vector<Edge> edges;
  std::vector<double> areas;  ///< by face; face 0 is the unbounded one, with area 0
};

/// Pieces may cross, touch and overlap. Those that come within the tolerance of each other meet: curves that nearly
/// touch get one common vertex, and no sliver arises between them. It leaves out ends that bound no face, and pieces no
/// longer than the tolerance. An arc turns by less than a full circle. O(pieces^2 + vertices^2)
[[nodiscard]] CurveArrangement arrange(std::span<const ProfileSegment> pieces, double tolerance);

/// Finds the faces of places.
class FaceLocator {
 public:
  /// O(edges)
  explicit FaceLocator(const CurveArrangement& arrangement);

  /// Any neighbouring face for a place on an edge. O(edges in a horizontal strip)
  [[nodiscard]] std::uint32_t face_at(const Eigen::Vector2d& place) const;

 private:
  /// A part of an edge that rises or falls all the way.
  struct Flank {
    double low, high;         ///< y
    double x, slope;          ///< of a line: x at y = 0, and dx / dy
    double centre_y, radius;  ///< of an arc, else radius 0; x is then that of the centre
    double side;              ///< 1 for the right half of the circle, -1 for the left one
    std::uint32_t face;       ///< towards +x
  };
  void add(const CurveArrangement::Edge& edge);
  void add(const Flank& flank);
  [[nodiscard]] std::size_t strip_of(double y) const;

  double low_ = 0, height_ = 1;  ///< of all strips
  std::vector<std::vector<Flank>> strips_;
};

}  // namespace cloud2csg
