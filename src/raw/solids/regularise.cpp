#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "cloud2csg/advanced/solids.hpp"
#include "core/geometry/subset.hpp"
#include "raw/solids/regular_places.hpp"

namespace cloud2csg {
namespace {

constexpr double k_deviations = 3;       // allowed error of a direction
constexpr double k_most_tolerances = 3;  // upper limit of that error, in tolerances of well determined values
/// Points that a changed surface is fitted to. No fewer than in detection (4096), or small changes make it less exact.
constexpr std::size_t k_most_fitted = 16384;

bool has_direction(SurfaceType type) {
  return type != SurfaceType::sphere;
}

bool has_axis(SurfaceType type) {
  return type == SurfaceType::cylinder || type == SurfaceType::cone || type == SurfaceType::torus;
}

bool has_radius(SurfaceType type) {
  return type == SurfaceType::cylinder || type == SurfaceType::sphere;
}

double weight_of(const DetectedSurface& detected) {
  return static_cast<double>(std::max<std::size_t>(detected.points.size(), 1));
}

/// Whether the points are less likely on a surface than they were before it changed. Their distances are normally
/// distributed.
bool leaves(std::span<const Eigen::Vector3d> points, const Surface& before, const Surface& changed) {
  constexpr double k_less = 1;  // logarithm of the ratio: a change within the uncertainty costs 0.5 for each value
  const auto squares = [points](const Surface& surface) {
    const auto square = [&](const Eigen::Vector3d& point) { return std::pow(signed_distance(surface, point), 2); };
    return std::transform_reduce(points.begin(), points.end(), 0.0, std::plus{}, square);
  };
  return 0.5 * static_cast<double>(points.size()) * std::log(squares(changed) / squares(before)) > k_less;
}

struct DirectionCluster {
  Eigen::Vector3d direction;
  double weight;
  bool is_fixed;
  std::vector<std::uint32_t> surfaces;
};

/// Snaps surface by surface to surfaces before it. Fixed surfaces are first, then those with more points.
class Regulariser {
 public:
  Regulariser(std::span<const DetectedSurface> surfaces, double distance_tolerance, double angle_tolerance_deg,
              std::span<const FixedValues> fixed, const Points& positions)
      : result_{.surfaces = {surfaces.begin(), surfaces.end()}, .snaps = {}},
        fixed_(fixed.begin(), fixed.end()),
        positions_(positions),
        shifts_(surfaces.size(), 0.0),
        distance_tolerance_(distance_tolerance),
        sine_tolerance_(std::sin(angle_tolerance_deg * std::numbers::pi / 180)),
        by_weight_(surfaces.size()) {
    fixed_.resize(surfaces.size());
    std::iota(by_weight_.begin(), by_weight_.end(), 0U);
    std::ranges::stable_sort(by_weight_, std::greater{}, [&](std::uint32_t i) { return weight_of(surfaces[i]); });
    AlignedBox box;
    for (const DetectedSurface& detected : surfaces) box.extend(detected.surface.position);
    if (!box.isEmpty() && box.diagonal().norm() > 0) {
      upright_sine_ = std::min(sine_tolerance_, distance_tolerance / box.diagonal().norm());
    }
  }

  RegularSurfaces run() {
    snap_directions();
    snap_offsets();
    snap_axes();
    snap_radii();
    snap_arrangements();
    return std::move(result_);
  }

 private:
  [[nodiscard]] Surface& surface(std::uint32_t i) { return result_.surfaces[i].surface; }

  /// By weight, but first the surfaces whose value is fixed.
  [[nodiscard]] std::vector<std::uint32_t> order(bool FixedValues::*value) const {
    std::vector<std::uint32_t> result = by_weight_;
    std::stable_partition(result.begin(), result.end(), [&](std::uint32_t i) { return fixed_[i].*value; });
    return result;
  }

  /// Gives the surface a new direction or axis. If it leaves its points, its other values follow: the apex of a cone
  /// may be far from its points, and a short piece of a pipe leaves much open.
  void change(std::uint32_t i, HeldValue held, const std::function<void(Surface&)>& make_change) {
    DetectedSurface& detected = result_.surfaces[i];
    const Surface before = detected.surface;
    make_change(detected.surface);
    if (positions_.size() == 0 || fixed_[i].position || fixed_[i].radius) return;
    std::vector<Eigen::Vector3d> points;
    for (const std::uint32_t index : some_of(detected.points, k_most_fitted)) points.push_back(positions_[index]);
    if (!leaves(points, before, detected.surface)) return;
    const std::optional<SurfaceFit> fit =
        fit_surface(detected.surface, points, {.most_points = k_most_fitted, .held = held});
    if (!fit) return;
    detected.surface = fit->surface;
    shifts_[i] = fit->uncertainty.position;
  }

  /// Larger if the surface's points leave its position more uncertain.
  [[nodiscard]] double distance_tolerance_of(std::uint32_t i) const {
    return std::clamp(k_deviations * shifts_[i], distance_tolerance_, k_most_tolerances * distance_tolerance_);
  }

  void note(RegularityKind kind, std::uint32_t i, double change) {
    if (change > 0) result_.snaps.push_back({.kind = kind, .surface = i, .change = change});
  }

  /// Larger if the surface's points leave its direction more uncertain.
  [[nodiscard]] double sine_tolerance_of(std::uint32_t i) const {
    const double sine = std::sin(result_.surfaces[i].turn_deg * std::numbers::pi / 180);
    return std::clamp(k_deviations * sine, sine_tolerance_, k_most_tolerances * sine_tolerance_);
  }

  std::vector<DirectionCluster> clusters() {
    std::vector<DirectionCluster> found;
    for (const std::uint32_t i : order(&FixedValues::direction)) {
      if (!has_direction(surface(i).type)) continue;
      const Eigen::Vector3d axis = surface(i).axis;
      const double weight = weight_of(result_.surfaces[i]);
      const auto same = std::ranges::find_if(found, [&](const DirectionCluster& cluster) {
        return cluster.direction.cross(axis).norm() <= sine_tolerance_of(i);
      });
      if (same == found.end()) {
        found.push_back({.direction = axis, .weight = weight, .is_fixed = fixed_[i].direction, .surfaces = {i}});
        continue;
      }
      const double sign = same->direction.dot(axis) < 0 ? -1 : 1;
      if (!same->is_fixed) same->direction = (same->weight * same->direction + weight * sign * axis).normalized();
      same->weight += weight;
      same->surfaces.push_back(i);
    }
    std::ranges::stable_sort(found, std::greater{}, &DirectionCluster::weight);
    std::stable_partition(found.begin(), found.end(), [](const DirectionCluster& cluster) { return cluster.is_fixed; });
    return found;
  }

  void snap_directions() {
    std::vector<Eigen::Vector3d> settled;
    for (const DirectionCluster& cluster : clusters()) {
      const Eigen::Vector3d direction =
          cluster.is_fixed ? cluster.direction : made_upright(made_orthogonal(cluster.direction, settled), settled);
      settled.push_back(direction);
      for (const std::uint32_t i : cluster.surfaces) {
        if (fixed_[i].direction) continue;
        const Eigen::Vector3d axis = surface(i).axis.dot(direction) < 0 ? Eigen::Vector3d(-direction) : direction;
        const double sine = std::min(surface(i).axis.cross(axis).norm(), 1.0);
        note(RegularityKind::direction, i, std::asin(sine) * 180 / std::numbers::pi);
        change(i, HeldValue::direction, [&](Surface& turned) { turned.axis = axis; });
      }
    }
  }

  /// Makes a direction orthogonal to the first two nearly orthogonal settled ones, if these are orthogonal.
  [[nodiscard]] Eigen::Vector3d made_orthogonal(const Eigen::Vector3d& direction,
                                                const std::vector<Eigen::Vector3d>& settled) const {
    std::vector<Eigen::Vector3d> across;
    for (const Eigen::Vector3d& other : settled) {
      const bool is_across = std::abs(direction.dot(other)) <= sine_tolerance_;
      const bool fits = across.empty() || std::abs(across[0].dot(other)) <= 1e-9;
      if (is_across && fits && across.size() < 2) across.push_back(other);
    }
    Eigen::Vector3d result = direction;
    for (const Eigen::Vector3d& other : across) result -= result.dot(other) * other;
    return result.normalized();
  }

  /// Aligns with a close coordinate axis, if that is no less orthogonal to the settled directions.
  [[nodiscard]] Eigen::Vector3d made_upright(const Eigen::Vector3d& direction,
                                             const std::vector<Eigen::Vector3d>& settled) const {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
      const bool fits = std::ranges::none_of(settled, [&](const Eigen::Vector3d& other) {
        return std::abs(direction.dot(other)) <= 1e-9 && std::abs(axis.dot(other)) > 1e-9;
      });
      if (fits && direction.cross(axis).norm() <= upright_sine_) return direction.dot(axis) < 0 ? -axis : axis;
    }
    return direction;
  }

  /// Groups of at least two surfaces like the first: one with a fixed value, or else the one with most points.
  template <typename IsLike>
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> groups(bool (*is_of)(SurfaceType), bool FixedValues::*value,
                                                               const IsLike& is_like) {
    std::vector<std::vector<std::uint32_t>> found;
    for (const std::uint32_t i : order(value)) {
      if (!is_of(surface(i).type)) continue;
      const auto same = std::ranges::find_if(found, [&](const auto& group) { return is_like(group[0], i); });
      if (same != found.end()) {
        same->push_back(i);
      } else {
        found.push_back({i});
      }
    }
    std::erase_if(found, [](const auto& group) { return group.size() < 2; });
    return found;
  }

  /// The group's common value: the fixed value of the first surface, or else the mean weighted by points.
  template <typename Value>
  [[nodiscard]] auto common(const std::vector<std::uint32_t>& group, bool FixedValues::*fixed, const Value& value) {
    if (fixed_[group[0]].*fixed) return decltype(value(group[0]))(value(group[0]));
    double weights = weight_of(result_.surfaces[group[0]]);
    auto sum = decltype(value(group[0]))(weights * value(group[0]));
    for (std::size_t k = 1; k < group.size(); ++k) {
      const double weight = weight_of(result_.surfaces[group[k]]);
      sum += weight * value(group[k]);
      weights += weight;
    }
    return decltype(value(group[0]))(sum / weights);
  }

  void snap_offsets() {
    const auto is_plane = [](SurfaceType type) { return type == SurfaceType::plane; };
    const auto are_coplanar = [this](std::uint32_t a, std::uint32_t b) {
      const double apart = surface(a).axis.dot(surface(b).position - surface(a).position);
      return are_parallel(a, b) && std::abs(apart) <= distance_tolerance_;
    };
    for (const std::vector<std::uint32_t>& group : groups(is_plane, &FixedValues::position, are_coplanar)) {
      const Surface anchor = surface(group[0]);
      const auto height = [&](std::uint32_t i) { return anchor.axis.dot(surface(i).position - anchor.position); };
      const double shared = common(group, &FixedValues::position, height);
      for (const std::uint32_t i : group) {
        if (fixed_[i].position) continue;
        const double change = shared - height(i);
        note(RegularityKind::offset, i, std::abs(change));
        surface(i).position += change * anchor.axis;
      }
    }
  }

  /// Offset between the axes of `a` and `b`, across the axis of `a`.
  [[nodiscard]] Eigen::Vector3d across(const Surface& a, const Surface& b) const {
    const Eigen::Vector3d offset = b.position - a.position;
    return offset - offset.dot(a.axis) * a.axis;
  }

  void snap_axes() {
    const auto are_coaxial = [this](std::uint32_t a, std::uint32_t b) {
      return are_parallel(a, b) && across(surface(a), surface(b)).norm() <= distance_tolerance_of(b);
    };
    for (const std::vector<std::uint32_t>& group : groups(has_axis, &FixedValues::position, are_coaxial)) {
      const Surface anchor = surface(group[0]);
      const auto shift = [&](std::uint32_t i) { return across(anchor, surface(i)); };
      const Eigen::Vector3d shared = common(group, &FixedValues::position, shift);
      for (const std::uint32_t i : group) {
        if (fixed_[i].position) continue;
        const Eigen::Vector3d offset = shared - shift(i);
        note(RegularityKind::axis, i, offset.norm());
        change(i, HeldValue::axis, [&](Surface& moved) { moved.position += offset; });
      }
    }
  }

  void snap_radii() {
    const auto are_equal = [this](std::uint32_t a, std::uint32_t b) {
      return surface(a).type == surface(b).type &&
             std::abs(surface(a).radius - surface(b).radius) <= distance_tolerance_;
    };
    for (const std::vector<std::uint32_t>& group : groups(has_radius, &FixedValues::radius, are_equal)) {
      const double shared = common(group, &FixedValues::radius, [this](std::uint32_t i) { return surface(i).radius; });
      for (const std::uint32_t i : group) {
        if (fixed_[i].radius) continue;
        note(RegularityKind::radius, i, std::abs(shared - surface(i).radius));
        surface(i).radius = shared;
      }
    }
  }

  /// Coaxial surfaces, which move together.
  struct Axis {
    std::vector<std::uint32_t> surfaces = {};
    bool is_fixed = false;
    double weight = 0;
    double least_radius = std::numeric_limits<double>::infinity();  ///< among its cylinders
  };

  /// Bundles of parallel axes.
  [[nodiscard]] std::vector<std::vector<Axis>> axes() {
    std::vector<std::vector<Axis>> found;
    for (const std::uint32_t i : by_weight_) {
      if (!has_axis(surface(i).type)) continue;
      auto bundle = std::ranges::find_if(found, [&](const auto& b) { return are_parallel(b[0].surfaces[0], i); });
      if (bundle == found.end()) bundle = found.emplace(found.end());
      const double rounding = 1e-6 * distance_tolerance_;
      auto axis = std::ranges::find_if(
          *bundle, [&](const Axis& a) { return across(surface(a.surfaces[0]), surface(i)).norm() <= rounding; });
      if (axis == bundle->end()) axis = bundle->emplace(bundle->end());
      axis->surfaces.push_back(i);
      axis->is_fixed = axis->is_fixed || fixed_[i].position;
      axis->weight += weight_of(result_.surfaces[i]);
      if (surface(i).type == SurfaceType::cylinder) {
        axis->least_radius = std::min(axis->least_radius, surface(i).radius);
      }
    }
    return found;
  }

  /// Across `direction`: the normal of the parallel plane with most points, or else a coordinate axis.
  [[nodiscard]] Eigen::Vector3d upright_across(const Eigen::Vector3d& direction) {
    for (const std::uint32_t i : by_weight_) {
      if (surface(i).type == SurfaceType::plane && std::abs(surface(i).axis.dot(direction)) < 1e-9) {
        return surface(i).axis;
      }
    }
    for (int k = 0; k < 3; ++k) {
      if (std::abs(direction[k]) < 1e-9) return Eigen::Vector3d::Unit(k);
    }
    return direction.unitOrthogonal();
  }

  /// Axes are alike if their least radii are equal. Axes that are fixed or have no cylinder are unique.
  [[nodiscard]] static std::vector<int> kinds_of(const std::vector<Axis>& bundle) {
    std::vector<int> kinds;
    for (std::size_t k = 0; k < bundle.size(); ++k) {
      const auto is_alike = [&](const Axis& other) { return other.least_radius == bundle[k].least_radius; };
      const bool may_move = !bundle[k].is_fixed && std::isfinite(bundle[k].least_radius);
      const auto first = may_move ? std::ranges::find_if(bundle, is_alike) - bundle.begin() : -1;
      kinds.push_back(may_move ? static_cast<int>(first) : -1 - static_cast<int>(k));
    }
    return kinds;
  }

  void snap_arrangements() {
    for (const std::vector<Axis>& bundle : axes()) {
      const Surface& any = surface(bundle[0].surfaces[0]);
      Eigen::Matrix<double, 3, 2> frame;
      frame.col(0) = upright_across(any.axis);
      frame.col(1) = any.axis.cross(frame.col(0));
      const Eigen::Vector3d origin = any.position;
      std::vector<Eigen::Vector2d> places;
      std::vector<double> weights;
      for (const Axis& axis : bundle) {
        places.emplace_back(frame.transpose() * (surface(axis.surfaces[0]).position - origin));
        weights.push_back(axis.weight);
      }
      const RegularPlaces regular = regular_places(places, kinds_of(bundle), weights, places, distance_tolerance_);
      for (std::size_t k = 0; k < bundle.size(); ++k) {
        const Eigen::Vector3d change = frame * (regular.places[k] - places[k]);
        for (const std::uint32_t i : bundle[k].surfaces) {
          note(RegularityKind::arrangement, i, change.norm());
          surface(i).position += change;
        }
      }
    }
  }

  [[nodiscard]] bool are_parallel(std::uint32_t a, std::uint32_t b) {
    return surface(a).axis.cross(surface(b).axis).norm() < 1e-9;
  }

  RegularSurfaces result_;
  std::vector<FixedValues> fixed_;
  const Points& positions_;     ///< those of the cloud; none: surfaces do not adapt
  std::vector<double> shifts_;  ///< standard deviations of the positions, where known
  double distance_tolerance_;
  double sine_tolerance_;
  double upright_sine_ = 0;  ///< angle at which no surface moves farther than the distance tolerance
  std::vector<std::uint32_t> by_weight_;
};

}  // namespace

std::string_view to_string(RegularityKind kind) {
  constexpr std::array<std::string_view, 7> k_names{"direction",       "offset",       "axis",       "radius",
                                                    "given direction", "given radius", "arrangement"};
  return k_names[static_cast<std::size_t>(kind)];
}

LargestChange largest_change(std::span<const Snap> snaps) {
  LargestChange largest;
  for (const Snap& snap : snaps) {
    const bool is_turn = snap.kind == RegularityKind::direction || snap.kind == RegularityKind::given_direction;
    double& change = is_turn ? largest.turn_deg : largest.shift;
    change = std::max(change, snap.change);
  }
  return largest;
}

RegularSurfaces regularise(std::span<const DetectedSurface> surfaces, double distance_tolerance,
                           double angle_tolerance_deg, std::span<const FixedValues> fixed, const Points& positions) {
  return Regulariser(surfaces, distance_tolerance, angle_tolerance_deg, fixed, positions).run();
}

}  // namespace cloud2csg
