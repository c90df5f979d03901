#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg::python {

/// `cloud2csg.PointCloud`: an immutable cloud with facts about its origin.
class Cloud {
 public:
  explicit Cloud(PointCloud points, bool is_exact = false, std::vector<std::string> warnings = {})
      : points_(std::move(points)), is_exact_(is_exact), warnings_(std::move(warnings)) {}

  [[nodiscard]] const PointCloud& points() const { return points_; }
  [[nodiscard]] bool is_exact() const { return is_exact_; }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

  /// Arrays of shape (n, 3), made on first use; None where the cloud has no such data.
  [[nodiscard]] pybind11::object position_rows() { return rows(points_.positions, position_rows_); }
  [[nodiscard]] pybind11::object normal_rows() { return rows(points_.normals, normal_rows_); }
  [[nodiscard]] pybind11::object sensor_rows() { return rows(points_.sensor_positions, sensor_rows_); }

 private:
  [[nodiscard]] pybind11::object rows(const Points& points, pybind11::object& kept) const;

  PointCloud points_;
  bool is_exact_;
  std::vector<std::string> warnings_;
  pybind11::object position_rows_, normal_rows_, sensor_rows_;
};

/// The cloud itself, or a new one from an argument of PointCloud(...): an array of positions.
/// @throws ValueError, TypeError
[[nodiscard]] pybind11::object to_cloud(const pybind11::object& cloud);

}  // namespace cloud2csg::python
