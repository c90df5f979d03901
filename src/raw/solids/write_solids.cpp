#include "raw/solids/write_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/boxes.hpp"
#include "core/primitive/profile.hpp"
#include "raw/solids/bare_surface.hpp"
#include "raw/solids/edges.hpp"
#include "raw/solids/outline.hpp"
#include "raw/solids/simplest_solid.hpp"
#include "raw/solids/term_ends.hpp"

namespace cloud2csg {
namespace {

constexpr double k_most_overshoot = 0.01;  // in diagonals of the bounds, which are far out

struct Span {
  double low, high;
};

/// The extent of a range of bins. Its ends may overshoot by half a bin, up to `most`.
Span span_of(const Bins& bins, BinRange range, const std::array<bool, 2>& overshoot, double most) {
  Span span{bins.edges[range.first], bins.edges[range.last + 1]};
  if (overshoot[0]) span.low -= std::min(0.5 * (span.low - bins.edges[range.first - 1]), most);
  if (overshoot[1]) span.high += std::min(0.5 * (bins.edges[range.last + 2] - span.high), most);
  return span;
}

/// A torus whose tube crosses the axis: an arc that ends on the axis, turned.
Primitive spindle(const Surface& torus, const Eigen::Vector3d& axis) {
  const double half_angle = std::acos(-torus.radius / torus.minor_radius);
  const double end = torus.minor_radius * std::sin(half_angle);
  const ClosedPath path{{.point = {0, -end}, .bulge = std::tan(half_angle / 2)}, {.point = {0, end}}};
  return {.id = {}, .shape = Revolution{{{path}}}, .pose = pose_from_axis(torus.position, axis)};
}

Primitive revolved_solid(const Surface& surface, const Span& span) {
  constexpr double k_rounding = 1e-6;  // of the radius of a tube that touches the axis
  const Eigen::Vector3d middle = surface.position + 0.5 * (span.low + span.high) * surface.axis;
  const double height = span.high - span.low;
  const Eigen::Vector3d axis = upright(surface.axis);
  switch (surface.type) {
    case SurfaceType::cylinder:
      return {.id = {}, .shape = Cylinder{surface.radius, height}, .pose = pose_from_axis(middle, axis)};
    case SurfaceType::cone: {
      const double slope = std::tan(surface.half_angle);
      Cone cone{.radius_bottom = std::max(slope * span.low, 0.0), .radius_top = slope * span.high, .height = height};
      if (axis != surface.axis) std::swap(cone.radius_bottom, cone.radius_top);
      return {.id = {}, .shape = cone, .pose = pose_from_axis(middle, axis)};
    }
    case SurfaceType::torus:
      if (surface.radius < (1 - k_rounding) * surface.minor_radius) return spindle(surface, axis);
      return {.id = {},
              .shape = Torus{std::max(surface.radius, surface.minor_radius), surface.minor_radius},
              .pose = pose_from_axis(surface.position, axis)};
    default:
      return {.id = {}, .shape = Sphere{surface.radius}, .pose = {.position = surface.position}};
  }
}

Plane world_plane(const TermSpace& space, std::uint32_t side) {
  const PlaneFamily& plane = space.planes[side / 2];
  if (side % 2 == 0) return {.normal = plane.normal, .offset = plane.offset};
  return {.normal = -plane.normal, .offset = -plane.offset};
}

/// Where a solid ends that nothing else ends: at `ends` if it would reach beyond `limits`. No overshoot reaches
/// farther.
struct EndRule {
  const AlignedBox& ends;
  const AlignedBox& limits;
};

Span within(const EndRule& rule, const Span& exact, const Span& wanted, const Eigen::Vector3d& origin,
            const Eigen::Vector3d& axis) {
  const auto [low, high] = extent_along(rule.ends, origin, axis);
  const auto [lowest, highest] = extent_along(rule.limits, origin, axis);
  return {exact.low < lowest ? low : std::max(wanted.low, lowest),
          exact.high > highest ? high : std::min(wanted.high, highest)};
}

Polytope closed_by(std::vector<Plane> planes, const AlignedBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    planes.push_back({.normal = Eigen::Vector3d::Unit(axis), .offset = box.max()[axis]});
    planes.push_back({.normal = -Eigen::Vector3d::Unit(axis), .offset = -box.min()[axis]});
  }
  return {std::move(planes)};
}

/// The planes, and the sides of a box where they leave its limits.
Polytope within(const EndRule& rule, const std::vector<Plane>& planes, double tolerance) {
  AlignedBox reached;
  for (const Eigen::Vector3d& corner : corners(closed_by(planes, rule.limits))) reached.extend(corner);
  AlignedBox box = rule.limits;
  for (int axis = 0; axis < 3; ++axis) {
    if (reached.min()[axis] < box.min()[axis] + tolerance) box.min()[axis] = rule.ends.min()[axis];
    if (reached.max()[axis] > box.max()[axis] - tolerance) box.max()[axis] = rule.ends.max()[axis];
  }
  return closed_by(planes, box);
}

/// The planes with at least three corners, relative to the middle of all corners.
Primitive polytope_solid(const TermSpace& space, const TermPart& part, const EndRule& rule) {
  const double tolerance = 1e-9 * space.bounds.diagonal().norm();
  std::vector<Plane> own;
  for (const std::uint32_t side : part.planes) own.push_back(world_plane(space, side));
  Polytope all = within(rule, own, tolerance);
  const std::vector<Eigen::Vector3d> points = corners(all);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) middle += point / static_cast<double>(points.size());
  Polytope needed;
  for (const Plane& plane : all.planes) {
    const auto held = std::ranges::count_if(
        points, [&](const Eigen::Vector3d& point) { return plane.normal.dot(point) > plane.offset - tolerance; });
    if (held >= 3) needed.planes.push_back({.normal = plane.normal, .offset = plane.offset - plane.normal.dot(middle)});
  }
  // Too far from the origin, rounding hides the corners. Keeps all planes, because a solid needs some.
  if (needed.planes.size() < 4) return {.id = {}, .shape = std::move(all), .pose = {}};
  return {.id = {}, .shape = std::move(needed), .pose = {.position = middle}};
}

/// Its local origin is in the middle of the profile.
Primitive extrusion_solid(const Pose& frame, Profile profile, const Span& span) {
  const Eigen::Vector2d middle = bounds_of(profile).center();
  for (ClosedPath& path : profile.paths) {
    for (PathCorner& corner : path) corner.point -= middle;
  }
  const Eigen::Vector3d place(middle.x(), middle.y(), 0.5 * (span.low + span.high));
  return {.id = {},
          .shape = Extrusion{std::move(profile), span.high - span.low},
          .pose = {.position = frame.position + frame.orientation * place, .orientation = frame.orientation}};
}

/// Turned by all of the range's angles. Its local origin is in the middle of the profile.
Primitive revolution_solid(const ProfileFamily& family, Profile profile, BinRange range) {
  const double middle = bounds_of(profile).center().y();
  for (ClosedPath& path : profile.paths) {
    for (PathCorner& corner : path) corner.point.y() -= middle;
  }
  const Pose& frame = family.chart.frame;
  Revolution revolution{std::move(profile)};
  Pose pose{.position = frame.to_world({0, 0, middle}), .orientation = frame.orientation};
  if (family.is_sector(range)) {
    const Span turn = span_of(family.slabs, range, {}, 0);
    revolution.angle_deg = (turn.high - turn.low) / std::numbers::pi * 180;
    pose.orientation = pose.orientation * Eigen::AngleAxisd(turn.low, Eigen::Vector3d::UnitZ());
  }
  return {.id = {}, .shape = std::move(revolution), .pose = pose};
}

/// Solids that add to the part end with it. Solids that subtract reach beyond all those.
Primitive solid_of(const TermSpace& space, const TermPart& part, const Overshoots& overshoots, bool adds) {
  const EndRule rule = adds ? EndRule{space.part_bounds, space.part_limits} : EndRule{space.bounds, space.bounds};
  if (part.kind == PartKind::polytope) return simplest(polytope_solid(space, part, rule));
  const auto span_along = [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
    const double most = k_most_overshoot * space.bounds.diagonal().norm();
    const Bins& bins = bins_of(space, part);
    const Span wanted = span_of(bins, part.range, overshoots, most);
    return within(rule, span_of(bins, part.range, {}, most), wanted, origin, axis);
  };
  if (part.kind == PartKind::profile) {
    const ProfileFamily& family = space.profiles[part.family];
    Profile outline = outline_of(family.chart.drawing, part.faces);
    if (family.chart.is_turned) return simplest(revolution_solid(family, std::move(outline), part.range));
    const Pose& frame = family.chart.frame;
    const Span span = span_along(frame.position, frame.orientation * Eigen::Vector3d::UnitZ());
    return simplest(extrusion_solid(frame, std::move(outline), span));
  }
  const Surface& surface = space.revolved[part.family].surface;
  const bool has_ends = surface.type == SurfaceType::cylinder || surface.type == SurfaceType::cone;
  return revolved_solid(surface, has_ends ? span_along(surface.position, surface.axis) : Span{0, 1});
}

Primitive solid_of(const AlignedBox& box) {
  return {.id = {}, .shape = Box{box.sizes()}, .pose = {.position = box.center()}};
}

/// A term or part as a tree, and where it may be.
struct WrittenTerm {
  CsgTree tree = {};
  AlignedBox reach = everywhere();
};

class SolidWriter {
 public:
  explicit SolidWriter(PrimitiveSet known) : solids(std::move(known)) {
    for (const Primitive& solid : solids) ids_.insert(solid.id);
  }

  PrimitiveIndex add(const TermSpace& space, const TermPart& part, const Overshoots& overshoots, bool adds) {
    if (part.is_known) return *space.revolved[part.family].known;
    for (const auto& [known, known_overshoots, known_adds, solid] : parts_) {
      TermPart plain = part;
      plain.is_inverted = known.is_inverted;
      if (plain == known && overshoots == known_overshoots && adds == known_adds) return solid;
    }
    Primitive solid = solid_of(space, part, overshoots, adds);
    const PrimitiveIndex index = add(std::move(solid));
    parts_.emplace_back(part, overshoots, adds, index);
    return index;
  }

  /// The part as if it was not inverted, and where it may be.
  WrittenTerm write(const TermSpace& space, const TermPart& part, const Overshoots& overshoots, bool adds) {
    const PrimitiveIndex solid = add(space, part, overshoots, adds);
    return {.tree = CsgTree::leaf(solid), .reach = bounds(solids[solid])};
  }

  /// @returns its index. Its id is its type and a number.
  PrimitiveIndex add(Primitive solid) {
    solid.id = new_id(std::string(type_name(solid.shape)));
    solids.push_back(std::move(solid));
    return static_cast<PrimitiveIndex>(solids.size() - 1);
  }

  PrimitiveSet solids;

 private:
  /// By type and number, different from the ids of known solids.
  std::string new_id(const std::string& type) {
    std::string id;
    do {
      id = fmt::format("{}_{}", type, numbers_[type]++);
    } while (ids_.contains(id));
    return id;
  }

  std::set<std::string> ids_;
  std::vector<std::tuple<TermPart, Overshoots, bool, PrimitiveIndex>> parts_;
  std::map<std::string, std::size_t> numbers_;
};

WrittenTerm write_term(const TermSpace& space, const Rule& rule, const std::vector<Overshoots>& overshoots,
                       SolidWriter& writer) {
  WrittenTerm term;
  if (keeps_one_part(rule)) {
    const TermPart& kept = rule.term.parts[1];
    const CsgTree tree = writer.write(space, kept, overshoots[1], kept.is_inverted).tree;
    return {.tree = kept.is_inverted ? complement(tree) : tree};
  }
  for (std::size_t p = 0; p < rule.term.parts.size(); ++p) {
    const TermPart& part = rule.term.parts[p];
    const auto [tree, reach] = writer.write(space, part, overshoots[p], rule.is_in != part.is_inverted);
    term.tree = p == 0 ? tree : part.is_inverted ? subtract(term.tree, tree) : intersect(term.tree, tree);
    if (!part.is_inverted) term.reach = term.reach.intersection(reach);
  }
  return term;
}

}  // namespace

WrittenSolids write_solids(const TermSpace& space, DecisionList list) {
  list = drawn_in(space, std::move(list));
  const std::vector<std::vector<Overshoots>> overshoots = free_ends(space, list);
  SolidWriter writer(space.known);
  std::vector<CsgTree> terms;
  std::vector<std::size_t> endless;  // rules that add where no solid can subtract, such as cylinders of many diagonals
  for (std::size_t r = 0; r < list.size(); ++r) {
    const WrittenTerm term = write_term(space, list[r], overshoots[r], writer);
    terms.push_back(term.tree);
    const bool is_given = std::ranges::any_of(list[r].term.parts,
                                              [](const TermPart& part) { return part.is_known && !part.is_inverted; });
    // A given solid stays as it is.
    if (list[r].is_in && !is_given && !space.bounds.contains(term.reach)) endless.push_back(r);
  }
  if (!endless.empty()) {
    const CsgTree around = CsgTree::leaf(writer.add(solid_of(space.part_bounds)));
    for (const std::size_t r : endless) terms[r] = intersect(terms[r], around);
  }
  CsgTree tree;
  for (std::size_t r = list.size(); r-- > 0;) {
    tree = list[r].is_in ? unite(tree, terms[r]) : subtract(tree, terms[r]);
  }
  return {.solids = std::move(writer.solids), .tree = simplify(tree)};
}

WrittenSolids without_what_sticks_out(WrittenSolids written, const AlignedBox& seen, const Points& points,
                                      double tolerance, const RunContext& run) {
  // That many are missing by chance in one of a million cases (e^-14), as in detection.
  constexpr double k_least_missing = 14;
  constexpr double k_beyond = 0.06;  // in diagonals; any side that ends nothing would do
  const BareSurface far = find_bare_surface(written.tree, written.solids, points, 2 * tolerance, run);
  AlignedBox box = seen;
  for (std::size_t i = 0; i < far.samples.size(); ++i) box.extend(far.samples.positions[i]);
  box = grown(box, k_beyond * seen.diagonal().norm());
  bool is_cut = false;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const double end = sign * (sign < 0 ? seen.min() : seen.max())[axis];
      double missing = 0;
      for (std::size_t i = 0; i < far.samples.size(); ++i) {
        const bool is_beyond = sign * far.samples.positions[i][axis] > end + 2 * tolerance;
        missing += is_beyond ? far.shares[i] * static_cast<double>(points.size()) : 0.0;
      }
      if (missing < k_least_missing) continue;
      (sign < 0 ? box.min() : box.max())[axis] = sign * (end + tolerance);
      is_cut = true;
    }
  }
  if (!is_cut) return written;
  SolidWriter writer(std::move(written.solids));
  const CsgTree tree = intersect(written.tree, CsgTree::leaf(writer.add(solid_of(box))));
  return {.solids = std::move(writer.solids), .tree = simplify(tree)};
}

}  // namespace cloud2csg
