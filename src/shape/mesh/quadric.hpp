#pragma once

#include <Eigen/Core>

namespace cloud2csg {

/// A sum of squared distances to tangent planes of the surface, in grid coordinates.
class Quadric {
 public:
  /// The plane through `point` with unit `normal`.
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const double offset = normal.dot(point);
    matrix_ += normal * normal.transpose();
    vector_ += offset * normal;
    constant_ += offset * offset;
    point_sum_ += point;
    count_ += 1;
  }
  void add(const Quadric& other) {
    matrix_ += other.matrix_;
    vector_ += other.vector_;
    constant_ += other.constant_;
    point_sum_ += other.point_sum_;
    count_ += other.count_;
  }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// Mean of the planes' points. Precondition: not empty.
  [[nodiscard]] Eigen::Vector3d mean_point() const { return point_sum_ / count_; }
  /// Root mean square distance of x to the planes.
  [[nodiscard]] double residual(const Eigen::Vector3d& x) const;

  struct Minimum {
    Eigen::Vector3d point;
    int rank;          ///< of the planes' normals: 1 on a smooth surface, 2 on a sharp edge, 3 at a corner
    double sharpness;  ///< smallest eigenvalue as a part of the largest: how clearly it is a corner
  };
  /// The minimum nearest to the mean point: directions in which the normals hardly vary are left alone.
  /// `cutoff`: eigenvalues below this part of the largest count as none.
  [[nodiscard]] Minimum minimum(double cutoff) const;
  /// The minimum within a box.
  [[nodiscard]] Eigen::Vector3d minimum_within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const;

 private:
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector_ = Eigen::Vector3d::Zero();
  double constant_ = 0;
  Eigen::Vector3d point_sum_ = Eigen::Vector3d::Zero();
  double count_ = 0;
};

}  // namespace cloud2csg
