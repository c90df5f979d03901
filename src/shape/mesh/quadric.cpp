#include "shape/mesh/quadric.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace cloud2csg {

double Quadric::residual(const Eigen::Vector3d& x) const {
  const double sum = x.dot(matrix_ * x) - 2.0 * vector_.dot(x) + constant_;
  return std::sqrt(std::max(sum, 0.0) / count_);
}

Quadric::Minimum Quadric::minimum(double cutoff) const {
  const Eigen::Vector3d mean = mean_point();
  const Eigen::Vector3d rest = vector_ - matrix_ * mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix_);
  const Eigen::Vector3d& eigenvalues = solver.eigenvalues();  // ascending
  Minimum minimum{.point = mean, .rank = 0, .sharpness = eigenvalues[0] / eigenvalues[2]};
  for (int i = 2; i >= 0 && eigenvalues[i] > cutoff * eigenvalues[2]; --i) {
    const Eigen::Vector3d direction = solver.eigenvectors().col(i);
    minimum.point += direction * (direction.dot(rest) / eigenvalues[i]);
    ++minimum.rank;
  }
  return minimum;
}

Eigen::Vector3d Quadric::minimum_within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
  // One coordinate at a time; a weak pull towards the mean point makes the minimum unique.
  constexpr int k_rounds = 32;
  constexpr double k_pull = 1e-3;
  const Eigen::Vector3d mean = mean_point();
  const Eigen::Matrix3d matrix = matrix_ + k_pull * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d vector = vector_ + k_pull * mean;
  Eigen::Vector3d x = mean.cwiseMax(low).cwiseMin(high);
  for (int round = 0; round < k_rounds; ++round) {
    for (int i = 0; i < 3; ++i) {
      const double others = matrix.row(i).dot(x) - matrix(i, i) * x[i];
      x[i] = std::clamp((vector[i] - others) / matrix(i, i), low[i], high[i]);
    }
  }
  return x;
}

}  // namespace cloud2csg
