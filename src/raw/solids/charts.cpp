#include "raw/solids/charts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/geometry/subset.hpp"
#include "raw/solids/curves.hpp"
#include "raw/solids/edges.hpp"
#include "raw/solids/sectors.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::size_t k_most_curve_points = 2000;  // of a curve; more tell no better where it ends
/// How far curves reach beyond their points, in diagonals of the drawing. Whole lines make six times as many faces.
constexpr double k_reach = 0.06;
constexpr double k_meeting = 1e-6;       // in diagonals: crossings that near are one, as in OpenSCAD
constexpr double k_gap = 3;              // in spacings: an edge farther from all points has none
constexpr double k_least_share = 0.002;  // of all points, on surfaces along the direction or axis

constexpr std::size_t k_sides = 4;  // of a box: least and greatest x, least and greatest y

Eigen::Index axis_across(std::size_t side) {
  return side < 2 ? 0 : 1;
}

double& place_of_side(Eigen::AlignedBox2d& box, std::size_t side) {
  return (side % 2 == 0 ? box.min() : box.max())[axis_across(side)];
}

/// A side of the box. Its points are the corners.
Curve line_along(Eigen::AlignedBox2d box, std::size_t side) {
  const Eigen::Index across = axis_across(side);
  const double place = place_of_side(box, side);
  box.min()[across] = box.max()[across] = place;
  return {.normal = Vector2d::Unit(across), .offset = place, .points = {box.min(), box.max()}};
}

/// How often surfaces agree on a direction, beyond those that define it: a plane across it, a cylinder along it, or two
/// planes along it that are not parallel. Any two planes share a direction.
std::size_t agreements(std::span<const Curve> curves, bool has_caps) {
  std::size_t constraints = has_caps ? 2 : 0;
  std::vector<Vector3d> normals;
  for (const Curve& curve : curves) {
    const Vector3d normal(curve.normal.x(), curve.normal.y(), 0);
    if (curve.is_circle) {
      constraints += 2;
    } else if (std::ranges::none_of(normals, [&](const Vector3d& known) { return are_parallel(known, normal); })) {
      constraints += 1;
      normals.push_back(normal);
    }
  }
  return constraints - std::min<std::size_t>(constraints, 2);
}

class ChartMaker {
 public:
  ChartMaker(const Points& positions, std::span<const DetectedSurface> surfaces, const ChartOptions& options)
      : positions_(positions),
        surfaces_(surfaces),
        options_(options),
        seen_(points_on(surfaces, positions)),
        middle_(bounds_of(seen_).center()),
        diagonal_(bounds_of(seen_).diagonal().norm()) {}

  std::vector<Chart> make() const {
    std::vector<Chart> charts = best_of(directions(), false, options_.most_directions);
    std::vector<Chart> turned = best_of(axes(), true, options_.most_axes);
    std::move(turned.begin(), turned.end(), std::back_inserter(charts));
    return charts;
  }

 private:
  [[nodiscard]] Pose frame_at(const Vector3d& origin, const Vector3d& direction) const {
    const Vector3d z = upright(direction.normalized());
    return pose_from_axis(origin + (middle_ - origin).dot(z) * z, z);
  }

  [[nodiscard]] std::vector<Pose> directions() const {
    std::vector<Pose> frames;
    const auto add = [&](const Vector3d& direction) {
      const auto is_known = [&](const Pose& frame) {
        return are_parallel(frame.orientation * Vector3d::UnitZ(), direction);
      };
      if (std::ranges::none_of(frames, is_known)) frames.push_back(frame_at(middle_, direction));
    };
    for (const DetectedSurface& s : surfaces_) {
      if (s.surface.type != SurfaceType::sphere) add(s.surface.axis);
    }
    // The direction of a prism without caps.
    constexpr std::size_t k_large = 8;
    std::vector<const DetectedSurface*> planes;
    for (const DetectedSurface& s : surfaces_) {
      if (s.surface.type == SurfaceType::plane) planes.push_back(&s);
    }
    std::ranges::stable_sort(planes, std::greater<>(), [](const DetectedSurface* s) { return s->points.size(); });
    planes.resize(std::min(planes.size(), k_large));
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Vector3d across = planes[i]->surface.axis.cross(planes[j]->surface.axis);
        if (across.norm() > 0.2) add(across.normalized());
      }
    }
    return frames;
  }

  [[nodiscard]] std::vector<Pose> axes() const {
    std::vector<Pose> frames;
    for (const DetectedSurface& s : surfaces_) {
      if (s.surface.type == SurfaceType::plane || s.surface.type == SurfaceType::sphere) continue;
      const Pose frame = frame_at(s.surface.position, s.surface.axis);
      const auto is_known = [&](const Pose& other) {
        return are_parallel(other.orientation * Vector3d::UnitZ(), s.surface.axis) &&
               other.to_local(frame.position).head<2>().norm() < options_.tolerance;
      };
      if (std::ranges::none_of(frames, is_known)) frames.push_back(frame);
    }
    return frames;
  }

  /// A plane across the direction.
  struct Cap {
    double height = 0;
    std::size_t count = 0;  ///< of its points
  };

  /// What a surface shows in a drawing.
  struct Trace {
    std::optional<Curve> curve = {};
    std::optional<double> cap = {};
  };

  [[nodiscard]] std::vector<Vector2d> points_of(const Chart& chart, const DetectedSurface& s) const {
    std::vector<Vector2d> points;
    for (const std::uint32_t i : some_of(s.points, k_most_curve_points))
      points.push_back(chart.place_of(positions_[i]));
    return points;
  }

  /// Beyond all points on both sides.
  [[nodiscard]] std::vector<Vector2d> far_points(const Curve& line) const {
    const Vector2d foot = line.offset * line.normal;
    const Vector2d arm = diagonal_ * to_the_left(line.normal);
    return {foot + arm, foot - arm};
  }

  /// Where a surface's points are in a chart.
  struct Extent {
    Vector3d middle;
    double along, across;  ///< infinite without points
  };

  [[nodiscard]] Extent extent_of(const Chart& chart, const DetectedSurface& s) const {
    constexpr double k_endless = std::numeric_limits<double>::infinity();
    if (s.points.empty()) return {chart.frame.to_local(s.surface.position), k_endless, k_endless};
    AlignedBox box;
    for (const std::uint32_t i : some_of(s.points, k_most_curve_points))
      box.extend(chart.frame.to_local(positions_[i]));
    return {box.center(), box.sizes().z(), box.sizes().head<2>().norm()};
  }

  /// Whether a tilt with that sine is below a degree, or moves nothing within the extent by more than the tolerance:
  /// small surfaces leave their direction uncertain.
  [[nodiscard]] bool is_untilted(double sine, double extent) const {
    return sine < k_level || (sine < k_most_tilt && sine * extent <= options_.tolerance);
  }

  [[nodiscard]] Trace trace_across(const Chart& chart, const DetectedSurface& s) const {
    const Vector3d axis = chart.frame.orientation.conjugate() * s.surface.axis;
    const Vector3d place = chart.frame.to_local(s.surface.position);
    const Extent extent = extent_of(chart, s);
    const double turned = axis.head<2>().norm();
    if (s.surface.type == SurfaceType::plane && is_untilted(turned, extent.across)) {
      return {.cap = place.z() - axis.head<2>().dot((extent.middle - place).head<2>()) / axis.z()};
    }
    if (s.surface.type == SurfaceType::plane && is_untilted(std::abs(axis.z()), extent.along)) {
      const double offset = axis.dot(place) - axis.z() * extent.middle.z();
      return {.curve = Curve{.normal = axis.head<2>() / turned, .offset = offset / turned}};
    }
    if (s.surface.type == SurfaceType::cylinder && is_untilted(turned, extent.along)) {
      return {.curve = Curve{
                  .is_circle = true, .normal = axis_at(extent.middle.z(), place, axis), .offset = s.surface.radius}};
    }
    return {};
  }

  /// Where an axis has that height.
  [[nodiscard]] static Vector2d axis_at(double height, const Vector3d& place, const Vector3d& axis) {
    return (place + (height - place.z()) / axis.z() * axis).head<2>();
  }

  [[nodiscard]] Trace trace_around(const Chart& chart, const DetectedSurface& s) const {
    const Vector3d axis = chart.frame.orientation.conjugate() * s.surface.axis;
    const Vector3d place = chart.frame.to_local(s.surface.position);
    const Vector2d centre(0, place.z());
    if (s.surface.type == SurfaceType::sphere) {
      if (place.head<2>().norm() >= options_.tolerance) return {};
      return {.curve = Curve{.is_circle = true, .normal = centre, .offset = s.surface.radius}};
    }
    const Extent extent = extent_of(chart, s);
    const double turned = axis.head<2>().norm();
    if (s.surface.type == SurfaceType::plane) {
      if (!is_untilted(turned, extent.across)) return {};
      const double height = place.z() - axis.head<2>().dot((extent.middle - place).head<2>()) / axis.z();
      return {.curve = Curve{.normal = Vector2d::UnitY(), .offset = height}};
    }
    const double height = s.surface.type == SurfaceType::cylinder ? extent.middle.z() : place.z();
    if (!is_untilted(turned, extent.along) || axis_at(height, place, axis).norm() >= options_.tolerance) return {};
    if (s.surface.type == SurfaceType::cylinder) {
      return {.curve = Curve{.normal = Vector2d::UnitX(), .offset = s.surface.radius}};
    }
    if (s.surface.type == SurfaceType::torus) {
      return {.curve = Curve{.is_circle = true,
                             .normal = Vector2d(s.surface.radius, place.z()),
                             .offset = s.surface.minor_radius}};
    }
    const double up = axis.z() > 0 ? 1 : -1;
    const Vector2d normal(std::cos(s.surface.half_angle), -up * std::sin(s.surface.half_angle));
    return {.curve = Curve{.normal = normal, .offset = normal.dot(centre)}};
  }

  /// The charts on whose direction the most surfaces agree, then those whose curves have the most points, without those
  /// that have hardly any.
  [[nodiscard]] std::vector<Chart> best_of(const std::vector<Pose>& frames, bool is_turned, std::size_t most) const {
    struct Candidate {
      Chart chart;
      std::vector<Curve> curves = {};
      std::vector<Cap> caps = {};
      std::vector<const DetectedSurface*> revolved = {};
      std::size_t agreements = 0;
      std::size_t count = 0;
    };
    std::vector<Candidate> candidates;
    for (const Pose& frame : frames) {
      Candidate candidate{.chart = {.is_turned = is_turned, .frame = frame}};
      for (const DetectedSurface& s : surfaces_) {
        Trace trace = is_turned ? trace_around(candidate.chart, s) : trace_across(candidate.chart, s);
        if (trace.cap) candidate.caps.push_back({.height = *trace.cap, .count = s.points.size()});
        if (!trace.curve) continue;
        trace.curve->points = s.points.empty() ? far_points(*trace.curve) : points_of(candidate.chart, s);
        trace.curve->count = s.points.size();
        if (!is_turned || s.surface.type != SurfaceType::plane) {
          candidate.count += s.points.size();
          candidate.revolved.push_back(&s);
        }
        candidate.curves.push_back(std::move(*trace.curve));
      }
      if (static_cast<double>(candidate.count) < k_least_share * static_cast<double>(positions_.size())) continue;
      if (!is_turned) candidate.agreements = agreements(candidate.curves, !candidate.caps.empty());
      if (candidate.count > 0) candidates.push_back(std::move(candidate));
    }
    std::ranges::stable_sort(candidates, std::greater<>(),
                             [](const Candidate& c) { return std::pair(c.agreements, c.count); });
    candidates.resize(std::min(candidates.size(), most));
    std::vector<Chart> charts;
    charts.reserve(candidates.size());
    for (Candidate& candidate : candidates) {
      Chart chart = drawn(std::move(candidate.chart), merged(std::move(candidate.curves), options_.tolerance));
      if (is_turned) {
        open_at_gaps(chart, std::move(candidate.revolved));
      } else {
        chart.caps = ends_in(chart, std::move(candidate.caps));
      }
      charts.push_back(std::move(chart));
    }
    return charts;
  }

  /// The border of a drawing, where the points end. A profile may end there for nothing, as a part on a table does;
  /// only where a line is, its price counts.
  struct Border {
    Eigen::AlignedBox2d box = {};
    std::array<std::uint32_t, k_sides> curves = {};  ///< by side: the line that it continues, or one beyond all
  };

  [[nodiscard]] Border border_of(const Chart& chart, std::span<const Curve> curves,
                                 const Eigen::AlignedBox2d& ends) const {
    Border border{.box = ends};
    if (chart.is_turned) border.box.min().x() = 0;
    for (std::size_t side = 0; side < k_sides; ++side) {
      border.curves[side] = static_cast<std::uint32_t>(curves.size() + side);
      if (chart.is_turned && side == 0) continue;  // the axis
      // Both sides of a thinner drawing may be one line.
      if (border.box.sizes()[axis_across(side)] <= 4 * options_.tolerance) continue;
      const Curve end = line_along(ends, side);
      const auto line =
          std::ranges::find_if(curves, [&](const Curve& curve) { return is_same(curve, end, options_.tolerance); });
      if (line == curves.end()) continue;
      border.curves[side] = static_cast<std::uint32_t>(line - curves.begin());
      const Vector2d middle = 0.5 * (end.points[0] + end.points[1]);
      const double off = line->normal.dot(middle) - line->offset;
      place_of_side(border.box, side) -= off / line->normal[axis_across(side)];
    }
    return border;
  }

  [[nodiscard]] Chart drawn(Chart chart, std::vector<Curve> curves) const {
    Eigen::AlignedBox2d ends;
    for (std::size_t i = 0; i < seen_.size(); ++i) ends.extend(chart.place_of(seen_[i]));
    const double diagonal = ends.diagonal().norm();
    curves = with_closed_gaps(std::move(curves), k_reach * diagonal, options_.tolerance);
    std::vector<ProfileSegment> pieces;
    std::vector<std::uint32_t> curve_of_piece;
    const auto add = [&](const ProfileSegment& piece, std::uint32_t curve) {
      pieces.push_back(piece);
      curve_of_piece.push_back(curve);
    };
    const std::vector<CurveExtent> extents = extents_of(curves, k_reach * diagonal);
    for (std::uint32_t c = 0; c < curves.size(); ++c) {
      for (const ProfileSegment& piece : pieces_of(curves[c], extents[c], chart.is_turned)) add(piece, c);
    }
    const std::size_t first_of_border = pieces.size();
    const Border border = border_of(chart, curves, with_ends_of_circles(ends, curves, options_.tolerance));
    for (std::size_t side = 0; side < k_sides; ++side) {
      Curve line = line_along(border.box, side);
      // The axis goes on where no face ends the points: there may be a tip.
      const auto is_bare = [&](std::size_t end) { return border.curves[end] == curves.size() + end; };
      if (chart.is_turned && side == 0 && is_bare(2)) line.points[0].y() -= k_reach * diagonal;
      if (chart.is_turned && side == 0 && is_bare(3)) line.points[1].y() += k_reach * diagonal;
      add(segment_between(line.points[0], 0, line.points[1]), border.curves[side]);
    }
    chart.drawing.is_turned = chart.is_turned;
    chart.drawing.arrangement = arrange(pieces, k_meeting * diagonal);
    for (const CurveArrangement::Edge& edge : chart.drawing.arrangement.edges) {
      const std::uint32_t curve = curve_of_piece[edge.piece];
      chart.drawing.curve_of_edge.push_back(curve);
      const double around = chart.is_turned ? 2 * std::numbers::pi * edge.segment.at(0.5).x() : 1.0;
      chart.drawing.price_of_edge.push_back(
          edge.piece >= first_of_border ? 0.0
                                        : around * bare_length(edge.segment, curves[curve], k_gap * options_.spacing));
    }
    return chart;
  }

  /// Turns the frame so that sectors may end at the angles of its caps and at pi.
  void open_at_gaps(Chart& chart, std::vector<const DetectedSurface*> revolved) const {
    std::vector<double> ends = sector_ends(chart.frame, positions_, std::move(revolved), surfaces_, options_.tolerance);
    if (ends.empty()) return;
    const double turn = ends.front() - std::numbers::pi;
    chart.frame.orientation = chart.frame.orientation * Eigen::AngleAxisd(turn, Vector3d::UnitZ());
    for (std::size_t k = 1; k < ends.size(); ++k) {
      chart.caps.push_back(std::remainder(ends[k] - turn, 2 * std::numbers::pi));
    }
    std::ranges::sort(chart.caps);
  }

  /// Distinct caps, of two near each other the one with more points, and the ends of the points where no cap is.
  [[nodiscard]] std::vector<double> ends_in(const Chart& chart, std::vector<Cap> caps) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      low = std::min(low, chart.level_of(seen_[i]));
      high = std::max(high, chart.level_of(seen_[i]));
    }
    std::erase_if(caps, [&](const Cap& cap) {
      return cap.height < low - options_.tolerance || cap.height > high + options_.tolerance;
    });
    std::ranges::stable_sort(caps, std::greater<>(), &Cap::count);
    std::vector<double> distinct;
    for (const Cap& cap : caps) add_distinct(distinct, {cap.height}, options_.tolerance);
    add_distinct(distinct, {low, high}, options_.tolerance);
    std::ranges::sort(distinct);
    return distinct;
  }

  static constexpr double k_level = 0.0175;    // the sine of a degree
  static constexpr double k_most_tilt = 0.26;  // the sine of 15 degrees

  const Points& positions_;
  std::span<const DetectedSurface> surfaces_;
  const ChartOptions& options_;
  Points seen_;
  Vector3d middle_;
  double diagonal_;
};

}  // namespace

Vector2d Chart::place_of(const Vector3d& point) const {
  const Vector3d local = frame.to_local(point);
  return is_turned ? Vector2d(local.head<2>().norm(), local.z()) : Vector2d(local.head<2>());
}

double Chart::level_of(const Vector3d& point) const {
  const Vector3d local = frame.to_local(point);
  return is_turned ? std::atan2(local.y(), local.x()) : local.z();
}

std::vector<Chart> make_charts(const Points& positions, std::span<const DetectedSurface> surfaces,
                               const ChartOptions& options) {
  return ChartMaker(positions, surfaces, options).make();
}

}  // namespace cloud2csg
