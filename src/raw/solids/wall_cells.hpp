#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Marked cells of a wall that was unrolled: rows along it, columns around it. Zero rows: nothing is ever marked.
class WallCells {
 public:
  WallCells() = default;
  WallCells(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), marks_(rows * columns, 0) {}

  /// Marks the cell of a place in rows and columns, or the nearest.
  void mark(double row, double column) {
    if (!marks_.empty()) marks_[clamped(row, rows_) * columns_ + clamped(column, columns_)] = 1;
  }

  /// Number of marked cells.
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(std::ranges::count(marks_, 1)); }

  /// Whether the cell of a place in rows and columns, or any of the eight around it, is marked.
  [[nodiscard]] bool is_any_near(double row, double column) const {
    return !marks_.empty() && is_any_around(clamped(row, rows_), clamped(column, columns_));
  }

  /// Whether the cell or any of the eight around it is marked.
  [[nodiscard]] bool is_any_around(std::size_t row, std::size_t column) const {
    for (std::size_t r = row - std::min<std::size_t>(row, 1); r < std::min(row + 2, rows_); ++r) {
      for (const std::size_t step : {columns_ - 1, columns_, columns_ + 1}) {
        if (marks_[r * columns_ + (column + step) % columns_] != 0) return true;
      }
    }
    return false;
  }

 private:
  static std::size_t clamped(double place, std::size_t count) {
    if (!(place > 0)) return 0;  // nor NaN, as of a wall without height
    return static_cast<std::size_t>(std::min(place, static_cast<double>(count) - 0.5));
  }

  std::size_t rows_ = 0, columns_ = 0;
  std::vector<char> marks_ = {};
};

/// Adds four points of a surface, spread over a cell with this middle, with normals and sensor positions.
/// `place_at(row, column)` is on the surface; a sensor is `depth_at(place)` in front of it.
template <typename PlaceAt, typename DepthAt>
void add_cell_points(PointCloud& points, const Surface& surface, double row, double column, PlaceAt place_at,
                     DepthAt depth_at) {
  for (const double along : {-0.25, 0.25}) {
    for (const double around : {-0.25, 0.25}) {
      const Eigen::Vector3d place = place_at(row + along, column + around);
      const Eigen::Vector3d out = normal(surface, place);
      points.positions.push_back(place);
      points.normals.push_back(out);
      points.sensor_positions.push_back(place + depth_at(place) * out);
    }
  }
}

}  // namespace cloud2csg
