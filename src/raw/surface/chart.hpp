#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// The unknowns of the surfaces of one type around one of them: as many as such a surface has, none of them redundant.
/// In this order: two tilts of the axis (none for a sphere), shifts of the position (of a plane along its normal, of a
/// cylinder or cone across the axis, of the others three), sizes. A cone is held by its radius where the middle of the
/// points is, times the cosine of its half angle, and not by its apex, which is anywhere for a narrow cone.
/// In the frame of unit_frame(), so that the origin is the middle of the points.
class Chart {
 public:
  static constexpr std::size_t k_most_unknowns = 7;
  using Row = std::array<double, k_most_unknowns>;

  explicit Chart(const Surface& start);

  [[nodiscard]] std::size_t unknowns() const { return tilts_ + shifts_ + sizes_; }
  [[nodiscard]] std::size_t tilts() const { return tilts_; }
  [[nodiscard]] std::size_t shifts() const { return shifts_; }
  /// The unknowns of the surface that the chart was made from.
  [[nodiscard]] Row start() const;

  /// A surface of the chart, in the form that distances are computed from.
  struct Place {
    Eigen::Vector3d position, axis;
    std::array<Eigen::Vector3d, 2> axis_by_tilt;
    std::array<double, 2> sizes;
    double sine, cosine;  ///< of a cone's half angle
  };
  /// Precondition: `values` has one value for each unknown.
  [[nodiscard]] Place at(std::span<const double> values) const;

  /// Distance from the surface, with the material inside; `slopes` receives its derivatives by the unknowns.
  [[nodiscard]] double distance(const Place& place, const Eigen::Vector3d& point) const;
  double distance(const Place& place, const Eigen::Vector3d& point, Row& slopes) const;

  /// Whether the place is a surface of the type: sizes above 0, angles within their range.
  [[nodiscard]] bool is_surface(const Place& place) const;
  /// Precondition: is_surface().
  [[nodiscard]] Surface surface(const Place& place) const;

 private:
  [[nodiscard]] std::size_t sizes_begin() const { return tilts_ + shifts_; }

  Surface start_;  ///< its position is where the chart has its origin
  Row start_sizes_ = {};
  std::array<Eigen::Vector3d, 3> directions_;  ///< first and second across the axis, and the axis
  std::size_t tilts_ = 0;
  std::size_t shifts_begin_ = 0;  ///< of the directions
  std::size_t shifts_ = 0;
  std::size_t sizes_ = 0;
};

}  // namespace cloud2csg
