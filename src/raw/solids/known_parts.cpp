#include "raw/solids/known_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "core/geometry/subset.hpp"
#include "core/primitive/profile.hpp"
#include "core/primitive/surface_points.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_most_points = 4000;  // for locating a surface
constexpr std::size_t k_most_named = 5;      // surfaces in one warning

std::string place_of(const Surface& surface) {
  const Vector3d& at = surface.position;
  return fmt::format("at ({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
}

/// "2 radii are none of those given: a, b" with the first few named.
std::string sentence(const std::string& what, const std::vector<std::string>& named) {
  const auto last = named.begin() + static_cast<std::ptrdiff_t>(std::min(k_most_named, named.size()));
  std::string text = fmt::format("{}: {}", what, fmt::join(named.begin(), last, "; "));
  if (last != named.end()) text += fmt::format("; and {} more", named.end() - last);
  return text;
}

/// A surface with its points, which decide what values it may take.
class Candidate {
 public:
  Candidate(const DetectedSurface& detected, const Points& positions) : surface_(detected.surface) {
    for (const std::uint32_t i : some_of(detected.points, k_most_points)) points_.push_back(positions[i]);
    rms_ = rms_of(surface_);
  }

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] double rms() const { return rms_; }
  [[nodiscard]] bool has_points() const { return !points_.empty(); }

  /// Tries another direction or radius, with the surface moved to fit its points. Accepts it if that adds at most
  /// `tolerance` to their distance. @returns the added distance if refused.
  std::optional<double> try_taking(const Surface& other, double tolerance) {
    const Surface settled = moved_to_points(other);
    const double rms = rms_of(settled);
    const double excess = std::sqrt(std::max(rms * rms - rms_ * rms_, 0.0));
    if (excess > tolerance) return excess;
    surface_ = settled;
    rms_ = rms;
    return std::nullopt;
  }

  /// The same without a limit.
  void take(const Surface& other) {
    surface_ = moved_to_points(other);
    rms_ = rms_of(surface_);
  }

 private:
  [[nodiscard]] double rms_of(const Surface& surface) const {
    double squares = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double distance = signed_distance(surface, points_[i]);
      squares += distance * distance;
    }
    return points_.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(points_.size()));
  }

  /// Least squares of distances. Directions that the points do not determine stay.
  [[nodiscard]] Surface moved_to_points(Surface surface) const {
    constexpr int k_rounds = 8;
    constexpr double k_open = 1e-6;
    for (int round = 0; round < k_rounds && has_points(); ++round) {
      Eigen::Matrix3d matrix = k_open * static_cast<double>(points_.size()) * Eigen::Matrix3d::Identity();
      Vector3d side = Vector3d::Zero();
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vector3d slope = normal(surface, points_[i]);
        matrix += slope * slope.transpose();
        side += signed_distance(surface, points_[i]) * slope;
      }
      surface.position += matrix.ldlt().solve(side);
    }
    return surface;
  }

  Surface surface_;
  Points points_;
  double rms_ = 0;
};

class GivenValues {
 public:
  GivenValues(const PointCloud& cloud, std::span<const DetectedSurface> surfaces, const RegularityOptions& options,
              double tolerance)
      : cloud_(cloud), options_(options), tolerance_(tolerance) {
    result_.surfaces.assign(surfaces.begin(), surfaces.end());
    result_.fixed.resize(surfaces.size());
  }

  GivenSurfaces run() {
    if (options_.axes.empty() && options_.radii.empty()) return std::move(result_);
    for (std::uint32_t i = 0; i < result_.surfaces.size(); ++i) {
      Candidate candidate(result_.surfaces[i], cloud_.positions);
      take_axis(i, candidate);
      take_radii(i, candidate);
      result_.surfaces[i].surface = candidate.surface();
      if (candidate.has_points()) result_.surfaces[i].rms = candidate.rms();
    }
    if (!other_axes_.empty()) {
      result_.warnings.push_back(sentence(
          "directions near given ones stay unchanged, since the points contradict the given ones", other_axes_));
    }
    if (!other_radii_.empty()) {
      result_.warnings.push_back(sentence("radii that match none of the given ones stay unchanged", other_radii_));
    }
    return std::move(result_);
  }

 private:
  void take_axis(std::uint32_t i, Candidate& candidate) {
    Surface surface = candidate.surface();
    if (options_.axes.empty() || surface.type == SurfaceType::sphere) return;
    double least_sine = 2;
    Vector3d nearest = surface.axis;
    for (const Vector3d& given : options_.axes) {
      const Vector3d axis = given.normalized();
      const double sine = surface.axis.cross(axis).norm();
      if (sine >= least_sine) continue;
      least_sine = sine;
      nearest = surface.axis.dot(axis) < 0 ? Vector3d(-axis) : axis;
    }
    const double turn_deg = std::asin(std::min(least_sine, 1.0)) * 180 / std::numbers::pi;
    if (turn_deg > std::max(options_.axis_tolerance_deg, options_.angle_tolerance_deg)) return;
    surface.axis = nearest;
    if (turn_deg <= options_.angle_tolerance_deg) {
      candidate.take(surface);
    } else if (const auto excess = candidate.try_taking(surface, tolerance_)) {
      other_axes_.push_back(fmt::format("{} {}, off by {:.2g} deg, which moves it {:.2g} from its points",
                                        type_name(surface.type), place_of(surface), turn_deg, *excess));
      return;
    }
    result_.fixed[i].direction = true;
    if (turn_deg > 0)
      result_.snaps.push_back({.kind = RegularityKind::given_direction, .surface = i, .change = turn_deg});
  }

  void take_radii(std::uint32_t i, Candidate& candidate) {
    const SurfaceType type = candidate.surface().type;
    if (options_.radii.empty() || type == SurfaceType::plane || type == SurfaceType::cone) return;
    // The tube of a torus first, because the radius of its middle depends on it.
    const bool is_tube_given = type != SurfaceType::torus || take_radius(i, candidate, &Surface::minor_radius);
    result_.fixed[i].radius = take_radius(i, candidate, &Surface::radius) && is_tube_given;
  }

  /// The major radius of a lemon is negative, and given radii are not.
  bool take_radius(std::uint32_t i, Candidate& candidate, double Surface::*radius) {
    Surface surface = candidate.surface();
    const double measured = surface.*radius;
    const auto difference = [&](double given) { return std::abs(given - std::abs(measured)); };
    surface.*radius = std::copysign(*std::ranges::min_element(options_.radii, {}, difference), measured);
    const bool is_valid = surface.type != SurfaceType::torus || surface.radius + surface.minor_radius > 0;
    if (!is_valid || candidate.try_taking(surface, tolerance_)) {
      other_radii_.push_back(
          fmt::format("{} {} of {:.4g}", type_name(surface.type), place_of(candidate.surface()), std::abs(measured)));
      return false;
    }
    const double change = std::abs(surface.*radius - measured);
    if (change > 0) result_.snaps.push_back({.kind = RegularityKind::given_radius, .surface = i, .change = change});
    return true;
  }

  const PointCloud& cloud_;
  const RegularityOptions& options_;
  double tolerance_;
  GivenSurfaces result_;
  std::vector<std::string> other_axes_, other_radii_;
};

using Eigen::Vector3d;

class SurfaceList {
 public:
  explicit SurfaceList(const Pose& pose) : pose_(pose), axis_(pose.orientation * Vector3d::UnitZ()) {}

  void operator()(const Box& box) {
    for (int side = 0; side < 3; ++side) {
      for (const double sign : {-1.0, 1.0}) add_plane(sign * Vector3d::Unit(side), 0.5 * box.size[side]);
    }
  }
  void operator()(const Sphere& sphere) {
    surfaces.push_back({.type = SurfaceType::sphere, .position = pose_.position, .radius = sphere.radius});
  }
  void operator()(const Cylinder& cylinder) {
    add_cylinder(cylinder.radius);
    add_ends(cylinder.height);
  }
  void operator()(const Cone& cone) {
    add_ends(cone.height);
    const double slope = (cone.radius_top - cone.radius_bottom) / cone.height;
    const double to_apex = -0.5 * cone.height - cone.radius_bottom / slope;
    if (!std::isfinite(to_apex)) {
      add_cylinder(cone.radius_top);
      return;
    }
    add_cone(to_apex, std::atan(std::abs(slope)), slope > 0);
  }
  void operator()(const Torus& torus) {
    surfaces.push_back({.type = SurfaceType::torus,
                        .position = pose_.position,
                        .axis = axis_,
                        .radius = torus.major_radius,
                        .minor_radius = torus.minor_radius});
  }
  void operator()(const HalfSpace& /*half_space*/) { add_plane(Vector3d::UnitZ(), 0); }
  void operator()(const Polytope& polytope) {
    for (const Plane& plane : polytope.planes) add_plane(plane.normal, plane.offset);
  }
  void operator()(const Extrusion& extrusion) {
    add_ends(extrusion.height);
    for (const ProfileSegment& s : segments_of(extrusion.profile)) {
      const Eigen::Vector2d normal = s.normal(0.5);
      if (s.is_arc()) {
        add_cylinder(s.radius, {s.centre.x(), s.centre.y(), 0}, s.angle < 0);
      } else {
        add_plane({normal.x(), normal.y(), 0}, normal.dot(s.start));
      }
    }
  }
  void operator()(const Revolution& revolution) {
    for (const ProfileSegment& s : segments_of(revolution.profile)) {
      if (s.is_arc()) {
        add_ring(s);
      } else if (!s.is_on_axis()) {
        add_turned_line(s);
      }
    }
    for (const ProfileCap& cap : caps_of(revolution)) add_plane(cap.normal, 0);
  }
  void operator()(const Expression& /*expression*/) {}

  std::vector<Surface> surfaces;

 private:
  /// In the solid's own frame.
  void add_plane(const Vector3d& normal, double offset) {
    surfaces.push_back({.type = SurfaceType::plane,
                        .position = pose_.to_world(offset * normal),
                        .axis = (pose_.orientation * normal).normalized()});
  }
  void add_ends(double height) {
    add_plane(Vector3d::UnitZ(), 0.5 * height);
    add_plane(-Vector3d::UnitZ(), 0.5 * height);
  }
  void add_cylinder(double radius, const Vector3d& place = Vector3d::Zero(), bool concave = false) {
    surfaces.push_back({.type = SurfaceType::cylinder,
                        .position = pose_.to_world(place),
                        .axis = axis_,
                        .radius = radius,
                        .concave = concave});
  }
  /// The cone with this apex on the axis that opens upward or downward.
  void add_cone(double apex, double half_angle, bool opens_upward, bool concave = false) {
    surfaces.push_back({.type = SurfaceType::cone,
                        .position = pose_.to_world(apex * Vector3d::UnitZ()),
                        .axis = opens_upward ? axis_ : Vector3d(-axis_),
                        .half_angle = half_angle,
                        .concave = concave});
  }
  /// The surface of an arc about the axis.
  void add_ring(const ProfileSegment& arc) {
    const bool is_sphere = std::abs(arc.centre.x()) <= k_on_axis * arc.radius;
    surfaces.push_back({.type = is_sphere ? SurfaceType::sphere : SurfaceType::torus,
                        .position = pose_.to_world(arc.centre.y() * Vector3d::UnitZ()),
                        .axis = axis_,
                        .radius = is_sphere ? arc.radius : arc.centre.x(),
                        .minor_radius = is_sphere ? 0 : arc.radius,
                        .concave = arc.angle < 0});
  }
  /// The surface of a line about the axis.
  void add_turned_line(const ProfileSegment& line) {
    const Eigen::Vector2d along = line.end - line.start;
    const Eigen::Vector2d normal = line.normal(0);
    if (std::abs(along.y()) <= k_on_axis * along.norm()) {
      add_plane(normal.y() * Vector3d::UnitZ(), normal.y() * line.start.y());
    } else if (std::abs(along.x()) <= k_on_axis * along.norm()) {
      add_cylinder(line.start.x(), Vector3d::Zero(), normal.x() < 0);
    } else {
      const double apex = line.start.y() - line.start.x() * along.y() / along.x();
      add_cone(apex, std::atan(std::abs(along.x() / along.y())), along.x() * along.y() > 0, normal.x() < 0);
    }
  }

  /// Rounding of directions and places, in lengths of a segment.
  static constexpr double k_on_axis = 1e-9;

  const Pose& pose_;
  Vector3d axis_;
};

std::vector<Surface> surfaces_of(const Primitive& solid) {
  if (!is_plain(solid)) return {};
  SurfaceList list(solid.pose);
  std::visit(list, solid.shape);
  return std::move(list.surfaces);
}

std::vector<DetectedSurface> with_points(const std::vector<Surface>& surfaces, const PointCloud& cloud,
                                         const KnownSolid& known) {
  std::vector<DetectedSurface> found;
  found.reserve(surfaces.size());
  for (const Surface& surface : surfaces) found.push_back({.surface = surface, .points = {}, .rms = known.own.rms});
  for (const std::uint32_t i : known.own.points) {
    const auto distance = [&](const DetectedSurface& one) {
      return std::abs(signed_distance(one.surface, cloud.positions[i]));
    };
    std::ranges::min_element(found, {}, distance)->points.push_back(i);
  }
  std::erase_if(found, [](const DetectedSurface& one) { return one.points.empty(); });
  return found;
}

}  // namespace

GivenSurfaces take_given_values(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                const RegularityOptions& options, double tolerance) {
  return GivenValues(cloud, surfaces, options, tolerance).run();
}

std::vector<DetectedSurface> surfaces_of_known(const PointCloud& cloud, std::span<const KnownSolid> known) {
  std::vector<DetectedSurface> all;
  for (const KnownSolid& one : known) {
    const std::vector<Surface> surfaces = surfaces_of(one.solid);
    if (surfaces.empty()) continue;
    const std::vector<DetectedSurface> found = with_points(surfaces, cloud, one);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace cloud2csg
