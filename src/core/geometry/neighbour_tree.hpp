#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// A kd-tree of points, which must outlive it. Build O(n log n), query O(k log n). Queries are thread-safe.
class NeighbourTree {
 public:
  explicit NeighbourTree(const Points& points);
  ~NeighbourTree();
  NeighbourTree(const NeighbourTree&) = delete;
  NeighbourTree& operator=(const NeighbourTree&) = delete;
  NeighbourTree(NeighbourTree&&) = delete;
  NeighbourTree& operator=(NeighbourTree&&) = delete;

  /// Fills `indices` and `squares` (of equal length) with the nearest points and their squared distances, nearest
  /// first. Returns how many it found: fewer than wanted when the cloud has fewer.
  std::size_t find(const Eigen::Vector3d& place, std::span<std::uint32_t> indices, std::span<double> squares) const;

  struct Neighbour {
    std::uint32_t point;
    double distance;
  };
  /// Precondition: there are points.
  [[nodiscard]] Neighbour nearest(const Eigen::Vector3d& place) const;
  /// Points nearer than `distance`, nearest first.
  [[nodiscard]] std::vector<std::uint32_t> within(const Eigen::Vector3d& place, double distance) const;
  /// All points, in an order that keeps successive points mostly near each other.
  [[nodiscard]] std::span<const std::uint32_t> order() const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace cloud2csg
