#include "pipeline/refine/solve.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "raw/surface/robust_loss.hpp"

namespace cloud2csg {
namespace {

constexpr double k_loose = 0.02;  // share of the size

constexpr double k_loose_turn = 0.035;  // radians
constexpr double k_turn_step = 1e-6;    // for central differences
constexpr double k_value_step = 2e-5;   // for central differences, as a share of a value's looseness
constexpr int k_most_iterations = 25;

using Turn = std::array<double, 3>;

Eigen::Vector3d vector_of(const double* turn) {
  return {turn[0], turn[1], turn[2]};
}

/// Residual that pulls a value or turn to its start with the weight of one point.
class Pull : public ceres::CostFunction {
 public:
  Pull(double from, double loose, int block, int entry) : from_(from), loose_(loose), entry_(entry) {
    mutable_parameter_block_sizes()->push_back(block);
    set_num_residuals(1);
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = (parameters[0][entry_] - from_) / loose_;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      std::fill_n(jacobians[0], parameter_block_sizes()[0], 0.0);
      jacobians[0][entry_] = 1 / loose_;
    }
    return true;
  }

 private:
  double from_, loose_;
  int entry_;
};

/// Distances of a member's points from it, with finite differences: cheap, and valid for every solid and displacement.
class OwnDistances : public ceres::CostFunction {
 public:
  OwnDistances(const Arrangement& arrangement, const Arrangement::Member& member, const Primitive& primitive,
               const Points& points, double noise)
      : arrangement_(arrangement), member_(member), primitive_(primitive), points_(points), noise_(noise) {
    mutable_parameter_block_sizes()->push_back(3);
    for (std::size_t k = 0; k < member.variables.size(); ++k) mutable_parameter_block_sizes()->push_back(1);
    set_num_residuals(static_cast<int>(points.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    Eigen::Vector3d turn = vector_of(parameters[0]);
    std::vector<double> values(member_.variables.size());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = member_.signs[k] * parameters[k + 1][0];
    std::vector<double> distances(points_.size());
    if (!measure(turn, values, distances)) return false;
    std::vector<double> slopes(points_.size());
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const auto [value, slope] = RobustLoss{}(distances[i] / noise_);
      residuals[i] = value;
      slopes[i] = slope / noise_;
    }
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr && !differentiate_by_turn(turn, values, slopes, jacobians[0])) return false;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (jacobians[k + 1] != nullptr && !differentiate_by_value(turn, values, k, slopes, jacobians[k + 1])) {
        return false;
      }
    }
    return true;
  }

 private:
  bool measure(const Eigen::Vector3d& turn, std::span<const double> values, std::span<double> distances) const {
    const std::optional<Primitive> moved = with_slots(primitive_, frame_of(arrangement_, member_, turn), values);
    if (!moved || !turn.allFinite()) return false;
    evaluate_distance(*moved, points_, distances);
    return true;
  }

  /// Fills a column of a row-major matrix by central differences.
  template <typename Shift>
  bool differentiate(const Shift& shift, double step, std::span<const double> slopes, double* column,
                     std::size_t stride) const {
    std::vector<double> above(points_.size());
    std::vector<double> below(points_.size());
    if (!shift(step, above) || !shift(-step, below)) return false;
    for (std::size_t i = 0; i < above.size(); ++i) {
      column[i * stride] = slopes[i] * (above[i] - below[i]) / (2 * step);
    }
    return true;
  }

  bool differentiate_by_turn(const Eigen::Vector3d& turn, std::span<const double> values,
                             std::span<const double> slopes, double* jacobian) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto shift = [&](double step, std::span<double> distances) {
        Eigen::Vector3d turned = turn;
        turned[axis] += step;
        return measure(turned, values, distances);
      };
      if (!differentiate(shift, k_turn_step, slopes, jacobian + axis, 3)) return false;
    }
    return true;
  }

  bool differentiate_by_value(const Eigen::Vector3d& turn, std::vector<double>& values, std::size_t k,
                              std::span<const double> slopes, double* jacobian) const {
    const double value = values[k];
    const auto shift = [&](double step, std::span<double> distances) {
      values[k] = value + member_.signs[k] * step;
      const bool is_solid = measure(turn, values, distances);
      values[k] = value;
      return is_solid;
    };
    return differentiate(shift, k_value_step * arrangement_.loose[member_.variables[k]], slopes, jacobian, 1);
  }

  const Arrangement& arrangement_;
  const Arrangement::Member& member_;
  const Primitive& primitive_;
  const Points& points_;
  double noise_;
};

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

}  // namespace

double looseness(const Primitive& primitive) {
  const Eigen::Vector3d half = oriented_bounds(primitive).half_size;
  const double size = half.allFinite() ? 2 * half.maxCoeff() : 1.0;
  return k_loose * std::max(size, 1e-12);
}

Arrangement separate(const PrimitiveSet& primitives, const std::vector<std::optional<Eigen::Vector3d>>& origins) {
  Arrangement result;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
    if (!origins[p]) continue;
    const LocalFrame frame{.orientation = primitives[p].pose.orientation, .origin = *origins[p]};
    const std::vector<Slot> slots = slots_of(primitives[p], frame);
    if (slots.empty()) continue;
    Arrangement::Member member{.primitive = p,
                               .frame = result.frames.size(),
                               .in_frame = Eigen::Quaterniond::Identity(),
                               .variables = {},
                               .signs = std::vector<double>(slots.size(), 1.0)};
    for (const Slot& slot : slots) {
      member.variables.push_back(result.values.size());
      result.values.push_back(slot.value);
      result.loose.push_back(looseness(primitives[p]));
    }
    result.frames.push_back(frame);
    result.members.push_back(std::move(member));
  }
  return result;
}

LocalFrame frame_of(const Arrangement& arrangement, const Arrangement::Member& member, const Eigen::Vector3d& turn) {
  const LocalFrame& frame = arrangement.frames[member.frame];
  return {.orientation = (rotation_by(turn) * frame.orientation * member.in_frame).normalized(),
          .origin = frame.origin};
}

PrimitiveSet arranged(const Arrangement& arrangement, PrimitiveSet primitives) {
  std::vector<double> values;
  for (const Arrangement::Member& member : arrangement.members) {
    values.clear();
    for (std::size_t k = 0; k < member.variables.size(); ++k) {
      values.push_back(member.signs[k] * arrangement.values[member.variables[k]]);
    }
    Primitive& primitive = primitives[member.primitive];
    if (auto moved = with_slots(primitive, frame_of(arrangement, member), values)) primitive = std::move(*moved);
  }
  return primitives;
}

void solve(Arrangement& arrangement, const PrimitiveSet& primitives, const OwnedPoints& points, double noise) {
  const Arrangement start = arrangement;
  std::vector<Turn> turns(start.frames.size(), Turn{});
  ceres::Problem problem;
  for (const Arrangement::Member& member : start.members) {
    std::vector<double*> blocks{turns[member.frame].data()};
    for (const std::size_t variable : member.variables) blocks.push_back(&arrangement.values[variable]);
    auto cost =
        std::make_unique<OwnDistances>(start, member, primitives[member.primitive], points[member.primitive], noise);
    problem.AddResidualBlock(cost.release(), nullptr, blocks);
  }
  for (std::size_t v = 0; v < start.values.size(); ++v) {
    auto pull = std::make_unique<Pull>(start.values[v], start.loose[v], 1, 0);
    problem.AddResidualBlock(pull.release(), nullptr, &arrangement.values[v]);
  }
  for (Turn& turn : turns) {
    for (int axis = 0; axis < 3; ++axis) {
      auto pull = std::make_unique<Pull>(0.0, k_loose_turn, 3, axis);
      problem.AddResidualBlock(pull.release(), nullptr, turn.data());
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = k_most_iterations;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;  // so that sums do not depend on threads
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    arrangement = start;
    return;
  }
  for (std::size_t f = 0; f < turns.size(); ++f) {
    LocalFrame& frame = arrangement.frames[f];
    frame.orientation = (rotation_by(vector_of(turns[f].data())) * frame.orientation).normalized();
  }
}

MemberUncertainty uncertainty_of(const Arrangement& arrangement, const Arrangement::Member& member,
                                 const Primitive& primitive, const Points& points, double noise) {
  const OwnDistances cost(arrangement, member, primitive, points, noise);
  const std::size_t slots = member.variables.size();
  const Turn turn{};
  std::vector<const double*> parameters{turn.data()};
  for (const std::size_t variable : member.variables) parameters.push_back(&arrangement.values[variable]);
  const auto count = static_cast<Eigen::Index>(points.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  RowMajor by_turn(count, 3);
  Eigen::MatrixXd by_slots(count, static_cast<Eigen::Index>(slots));
  std::vector<double*> jacobians{by_turn.data()};
  for (std::size_t k = 0; k < slots; ++k) jacobians.push_back(by_slots.col(static_cast<Eigen::Index>(k)).data());
  Eigen::VectorXd residuals(count);
  constexpr double k_never = std::numeric_limits<double>::infinity();
  if (!cost.Evaluate(parameters.data(), residuals.data(), jacobians.data())) {
    return {.turn = k_never, .slots = std::vector<double>(slots, k_never)};
  }
  const auto size = static_cast<Eigen::Index>(slots) + 3;
  Eigen::MatrixXd slopes(count, size);
  slopes << by_turn, by_slots;
  Eigen::MatrixXd information = slopes.transpose() * slopes;
  information.diagonal().head<3>().array() += 1 / (k_loose_turn * k_loose_turn);
  for (std::size_t k = 0; k < slots; ++k) {
    const double loose = arrangement.loose[member.variables[k]];
    information(static_cast<Eigen::Index>(k) + 3, static_cast<Eigen::Index>(k) + 3) += 1 / (loose * loose);
  }
  const Eigen::MatrixXd covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  Eigen::Matrix3d of_turn = covariance.topLeftCorner<3, 3>();
  if (is_turned_around_axis(primitive)) {
    const Eigen::Vector3d axis = frame_of(arrangement, member).orientation * Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    of_turn = across * of_turn * across;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(of_turn, Eigen::EigenvaluesOnly);
  MemberUncertainty result{.turn = std::sqrt(std::max(parts.eigenvalues()[2], 0.0)), .slots = {}};
  for (std::size_t k = 0; k < slots; ++k) {
    const auto diagonal = static_cast<Eigen::Index>(k) + 3;
    result.slots.push_back(std::sqrt(std::max(covariance(diagonal, diagonal), 0.0)));
  }
  return result;
}

}  // namespace cloud2csg
