#include "core/geometry/neighbour_tree.hpp"

#include <cmath>
#include <nanoflann.hpp>
#include <utility>

namespace cloud2csg {
namespace {

constexpr std::size_t k_leaf_points = 20;  ///< the fastest for 12 to 50 neighbours

/// nanoflann's interface to the points.
struct PointsAdaptor {
  const Points& points;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i];
  }
  template <typename BoundingBox>
  bool kdtree_get_bbox(BoundingBox& /*box*/) const {
    return false;  // nanoflann then computes the box
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsAdaptor>, PointsAdaptor,
                                                   3, std::uint32_t>;

}  // namespace

struct NeighbourTree::Index {
  explicit Index(const Points& points)
      : adaptor{points}, tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(k_leaf_points)) {}
  PointsAdaptor adaptor;
  KdTree tree;
};

NeighbourTree::NeighbourTree(const Points& points) : index_(std::make_unique<Index>(points)) {}
NeighbourTree::~NeighbourTree() = default;

std::size_t NeighbourTree::find(const Eigen::Vector3d& place, std::span<std::uint32_t> indices,
                                std::span<double> squares) const {
  return index_->tree.knnSearch(place.data(), indices.size(), indices.data(), squares.data());
}

NeighbourTree::Neighbour NeighbourTree::nearest(const Eigen::Vector3d& place) const {
  std::uint32_t point = 0;
  double square = 0;
  index_->tree.knnSearch(place.data(), 1, &point, &square);
  return {point, std::sqrt(square)};
}

std::vector<std::uint32_t> NeighbourTree::within(const Eigen::Vector3d& place, double distance) const {
  std::vector<std::pair<std::uint32_t, double>> found;
  index_->tree.radiusSearch(place.data(), distance * distance, found, nanoflann::SearchParams());
  std::vector<std::uint32_t> points;
  points.reserve(found.size());
  for (const auto& [point, square] : found) points.push_back(point);
  return points;
}

std::span<const std::uint32_t> NeighbourTree::order() const {
  return index_->tree.vAcc;
}

}  // namespace cloud2csg
