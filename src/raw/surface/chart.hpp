#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "cloud2csg/advanced/surface.hpp"
#include "raw/surface/profile.hpp"

namespace cloud2csg {

/// A minimal set of unknowns for surfaces of one type near a given surface. In this order: two tilts of the axis (none
/// for a sphere); shifts of the position (a plane's along its normal, a cylinder's or cone's across the axis, otherwise
/// three); sizes. A cone's size is its radius at the middle of the points times the cosine of its half angle, because
/// the apex of a narrow cone is ill-defined. In the frame of unit_frame(), whose origin is that middle.
class Chart {
 public:
  static constexpr std::size_t k_most_unknowns = 7;
  using Row = std::array<double, k_most_unknowns>;

  explicit Chart(const Surface& start);

  [[nodiscard]] std::size_t unknowns() const { return tilts_ + shifts_ + sizes_; }
  [[nodiscard]] std::size_t tilts() const { return tilts_; }
  [[nodiscard]] std::size_t shifts() const { return shifts_; }
  /// How many of the first unknowns a fit holds: of a plane, `axis` holds the direction, and of a sphere nothing.
  [[nodiscard]] std::size_t held(HeldValue value) const {
    if (value == HeldValue::none) return 0;
    const bool has_axis = tilts_ > 0 && sizes_ > 0;
    return value == HeldValue::axis && has_axis ? tilts_ + 2 : tilts_;
  }
  /// The unknowns of the surface passed to the constructor.
  [[nodiscard]] Row start() const;

  /// A surface of the chart, prepared for computing distances.
  struct Place {
    Eigen::Vector3d position, axis;
    std::array<Eigen::Vector3d, 2> axis_by_tilt;
    std::array<double, 2> sizes;
    double sine, cosine;  ///< for a cone's half angle
  };
  /// Precondition: `values` has one value for each unknown.
  [[nodiscard]] Place at(std::span<const double> values) const;

  /// Signed distance as if the material were inside; `slopes` receives the derivatives by the unknowns.
  [[nodiscard]] double distance(const Place& place, const Eigen::Vector3d& point) const;
  double distance(const Place& place, const Eigen::Vector3d& point, Row& slopes) const;

  /// Whether sizes are above 0 and angles are within their range.
  [[nodiscard]] bool is_surface(const Place& place) const;
  /// Precondition: is_surface().
  [[nodiscard]] Surface surface(const Place& place) const;

 private:
  [[nodiscard]] std::size_t sizes_begin() const { return tilts_ + shifts_; }

  Surface start_;  ///< its position is the chart's origin
  Row start_sizes_ = {};
  std::array<Eigen::Vector3d, 3> directions_;  ///< first and second across the axis, and the axis
  std::size_t tilts_ = 0;
  std::size_t shifts_begin_ = 0;  ///< index of the first shift in `directions_`
  std::size_t shifts_ = 0;
  std::size_t sizes_ = 0;
};

/// The distance and its derivatives by the sizes.
struct SizedProfile {
  ProfileDistance profile;
  std::array<double, 2> by_size;
};

/// Inline, as are the distances: fits spend most of their time here.
[[nodiscard]] inline SizedProfile profile_at(SurfaceType type, const Chart::Place& place, const AxialPoint& at) {
  switch (type) {
    case SurfaceType::plane:
      return {{at.height, 0, 1}, {}};
    case SurfaceType::sphere:
      return {circle_profile(0, place.sizes[0], at), {-1, 0}};
    case SurfaceType::cylinder:
      return {{at.radial - place.sizes[0], 1, 0}, {-1, 0}};
    case SurfaceType::cone:
      return {{at.radial * place.cosine - at.height * place.sine - place.sizes[0], place.cosine, -place.sine},
              {-1, -at.radial * place.sine - at.height * place.cosine}};
    case SurfaceType::torus: {
      const ProfileDistance profile = circle_profile(place.sizes[0], place.sizes[1], at);
      return {profile, {-profile.by_radial, -1}};
    }
  }
  return {};
}

inline double Chart::distance(const Place& place, const Eigen::Vector3d& point) const {
  return profile_at(start_.type, place, axial_point(place.position, place.axis, point)).profile.distance;
}

inline double Chart::distance(const Place& place, const Eigen::Vector3d& point, Row& slopes) const {
  const AxialPoint at = axial_point(place.position, place.axis, point);
  const auto [profile, by_size] = profile_at(start_.type, place, at);
  std::size_t next = 0;
  if (tilts_ > 0) {
    // Tilting the axis towards the point moves the point up the axis and nearer to it.
    const double by_turn = profile.by_height * at.radial - profile.by_radial * at.height;
    for (const Eigen::Vector3d& turn : place.axis_by_tilt) slopes[next++] = by_turn * at.outward.dot(turn);
  }
  const Eigen::Vector3d gradient = profile.by_radial * at.outward + profile.by_height * place.axis;
  for (std::size_t i = 0; i < shifts_; ++i) {
    slopes[next++] = -gradient.dot(directions_[shifts_begin_ + i]);
  }
  for (std::size_t i = 0; i < sizes_; ++i) slopes[next++] = by_size[i];
  return profile.distance;
}

}  // namespace cloud2csg
