#include "solids/write_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "cloud2csg/simplify.hpp"

namespace cloud2csg {
namespace {

constexpr double k_most_overshoot = 0.01;  // of the diagonal of the bounds, which are far out

/// How far ends are moved into bins that make no difference, by part, side and end.
using Overshoots = std::array<std::array<bool, 2>, 3>;

std::vector<std::uint8_t> decisions_of(const DecisionList& list, std::size_t places) {
  const std::vector<std::uint16_t> deciding = deciding_rules(list, places);
  std::vector<std::uint8_t> is_in(places);
  for (std::size_t i = 0; i < places; ++i) {
    is_in[i] = deciding[i] < list.size() && list[deciding[i]].is_in ? 1 : 0;
  }
  return is_in;
}

const Bins& bins_of(const TermSpace& space, const TermPart& part, std::size_t side) {
  return part.kind == PartKind::box ? space.boxes[part.family].bins[side] : space.revolved[part.family].bins;
}

std::size_t sides_of(const TermPart& part) {
  return part.kind == PartKind::box ? 3 : part.kind == PartKind::revolved ? 1 : 0;
}

/// Draws ends in, and finds those that may overshoot, where the list decides all places as before.
class Ends {
 public:
  Ends(const TermSpace& space, DecisionList& list)
      : space_(space), list_(list), wanted_(decisions_of(list, space.size())) {}

  void draw_in(std::size_t rule, std::size_t part) {
    for (std::size_t side = 0; side < sides_of(list_[rule].term.parts[part]); ++side) {
      while (try_range(rule, part, side, 1, 0)) {
      }
      while (try_range(rule, part, side, 0, -1)) {
      }
    }
  }

  Overshoots overshoots(std::size_t rule, std::size_t part) {
    Overshoots result{};
    const Term kept = list_[rule].term;
    for (std::size_t side = 0; side < sides_of(kept.parts[part]); ++side) {
      result[side][0] = try_range(rule, part, side, -1, 0);
      result[side][1] = try_range(rule, part, side, 0, 1);
    }
    set_term(rule, kept);
    return result;
  }

 private:
  void set_term(std::size_t rule, const Term& term) {
    list_[rule].term = term;
    list_[rule].members = members_of(space_, term);
  }

  /// Moves the ends of a range if that changes nothing.
  bool try_range(std::size_t rule, std::size_t part, std::size_t side, int first_step, int last_step) {
    const Term kept = list_[rule].term;
    Term moved = kept;
    BinRange& range = moved.parts[part].ranges[side];
    const std::int64_t first = std::int64_t{range.first} + first_step;
    const std::int64_t last = std::int64_t{range.last} + last_step;
    if (first < 0 || last >= bins_of(space_, kept.parts[part], side).count() || first > last) return false;
    range = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
    const bool grows = first_step < 0 || last_step > 0;
    if (grows && !reaches_other_places(kept.parts[part], moved.parts[part])) return false;
    set_term(rule, moved);
    if (decisions_of(list_, space_.size()) == wanted_) return true;
    set_term(rule, kept);
    return false;
  }

  /// Of a bin without places nothing is known.
  [[nodiscard]] bool reaches_other_places(TermPart a, TermPart b) const {
    a.is_inverted = false;
    b.is_inverted = false;
    return members_of(space_, {.parts = {a}}) != members_of(space_, {.parts = {b}});
  }

  const TermSpace& space_;
  DecisionList& list_;
  std::vector<std::uint8_t> wanted_;
};

struct Span {
  double low, high;
};

/// Of a range of bins, with ends that may overshoot half a bin, but not too far.
Span span_of(const Bins& bins, BinRange range, const std::array<bool, 2>& overshoot, double most) {
  Span span{bins.edges[range.first], bins.edges[range.last + 1]};
  if (overshoot[0]) span.low -= std::min(0.5 * (span.low - bins.edges[range.first - 1]), most);
  if (overshoot[1]) span.high += std::min(0.5 * (bins.edges[range.last + 2] - span.high), most);
  return span;
}

/// What the box takes up along an axis.
Span extent(const AlignedBox& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
  const double middle = (box.center() - origin).dot(axis);
  const double half = 0.5 * box.sizes().dot(axis.cwiseAbs());
  return {middle - half, middle + half};
}

Primitive box_solid(const BoxFamily& boxes, const std::array<Span, 3>& spans) {
  Eigen::Vector3d middle;
  Eigen::Vector3d size;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Span span = spans[static_cast<std::size_t>(axis)];
    middle[axis] = 0.5 * (span.low + span.high);
    size[axis] = span.high - span.low;
  }
  return {.id = {},
          .shape = Box{size},
          .pose = {.position = boxes.axes * middle, .orientation = Eigen::Quaterniond(boxes.axes).normalized()}};
}

Primitive revolved_solid(const Surface& surface, const Span& span) {
  const Eigen::Vector3d middle = surface.position + 0.5 * (span.low + span.high) * surface.axis;
  const double height = span.high - span.low;
  switch (surface.type) {
    case SurfaceType::cylinder:
      return {.id = {}, .shape = Cylinder{surface.radius, height}, .pose = pose_from_axis(middle, surface.axis)};
    case SurfaceType::cone: {
      const double slope = std::tan(surface.half_angle);
      return {
          .id = {},
          .shape =
              Cone{.radius_bottom = std::max(slope * span.low, 0.0), .radius_top = slope * span.high, .height = height},
          .pose = pose_from_axis(middle, surface.axis)};
    }
    case SurfaceType::torus:
      return {.id = {},
              .shape = Torus{surface.radius, surface.minor_radius},
              .pose = pose_from_axis(surface.position, surface.axis)};
    default:
      return {.id = {}, .shape = Sphere{surface.radius}, .pose = {.position = surface.position}};
  }
}

Plane world_plane(const TermSpace& space, std::uint32_t side) {
  const PlaneFamily& plane = space.planes[side / 2];
  if (side % 2 == 0) return {.normal = plane.normal, .offset = plane.offset};
  return {.normal = -plane.normal, .offset = -plane.offset};
}

/// The planes that hold a corner or more, about the middle of the corners.
Primitive polytope_solid(const TermSpace& space, const TermPart& part, const AlignedBox& bounds) {
  Polytope all;
  for (const std::uint32_t side : part.planes) all.planes.push_back(world_plane(space, side));
  for (int axis = 0; axis < 3; ++axis) {
    all.planes.push_back({.normal = Eigen::Vector3d::Unit(axis), .offset = bounds.max()[axis]});
    all.planes.push_back({.normal = -Eigen::Vector3d::Unit(axis), .offset = -bounds.min()[axis]});
  }
  const std::vector<Eigen::Vector3d> points = corners(all);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) middle += point / static_cast<double>(points.size());
  const double tolerance = 1e-9 * space.bounds.diagonal().norm();
  Polytope needed;
  for (const Plane& plane : all.planes) {
    const auto held = std::ranges::count_if(
        points, [&](const Eigen::Vector3d& point) { return plane.normal.dot(point) > plane.offset - tolerance; });
    if (held >= 3) needed.planes.push_back({.normal = plane.normal, .offset = plane.offset - plane.normal.dot(middle)});
  }
  return {.id = {}, .shape = std::move(needed), .pose = {.position = middle}};
}

/// Solids that add to the part end where it does at the latest; those that take from it reach beyond all that add.
Primitive solid_of(const TermSpace& space, const TermPart& part, const Overshoots& overshoots, bool adds) {
  const AlignedBox& bounds = adds ? space.part_bounds : space.bounds;
  const double most = k_most_overshoot * space.bounds.diagonal().norm();
  const auto span = [&](std::size_t side, const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) {
    const Span wanted = span_of(bins_of(space, part, side), part.ranges[side], overshoots[side], most);
    const Span limit = extent(bounds, origin, axis);
    return Span{std::max(wanted.low, limit.low), std::min(wanted.high, limit.high)};
  };
  if (part.kind == PartKind::box) {
    const BoxFamily& boxes = space.boxes[part.family];
    const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    return box_solid(boxes, {span(0, origin, boxes.axes.col(0)), span(1, origin, boxes.axes.col(1)),
                             span(2, origin, boxes.axes.col(2))});
  }
  if (part.kind == PartKind::polytope) return polytope_solid(space, part, bounds);
  const Surface& surface = space.revolved[part.family].surface;
  const bool has_ends = surface.type == SurfaceType::cylinder || surface.type == SurfaceType::cone;
  return revolved_solid(surface, has_ends ? span(0, surface.position, surface.axis) : Span{0, 1});
}

/// Adds solids, each once, to those that are known.
class SolidWriter {
 public:
  explicit SolidWriter(PrimitiveSet known) : solids(std::move(known)), known_(solids.size()) {
    for (const Primitive& solid : solids) ids_.insert(solid.id);
  }

  PrimitiveIndex add(const TermSpace& space, const TermPart& part, const Overshoots& overshoots, bool adds) {
    if (part.is_known) return *space.revolved[part.family].known;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const auto& [known, known_overshoots, known_adds] = parts_[i];
      TermPart plain = part;
      plain.is_inverted = known.is_inverted;
      if (plain == known && overshoots == known_overshoots && adds == known_adds) {
        return static_cast<PrimitiveIndex>(known_ + i);
      }
    }
    Primitive solid = solid_of(space, part, overshoots, adds);
    solid.id = new_id(std::string(type_name(solid.shape)));
    solids.push_back(std::move(solid));
    parts_.emplace_back(part, overshoots, adds);
    return static_cast<PrimitiveIndex>(solids.size() - 1);
  }

  PrimitiveSet solids;

 private:
  /// By type and number, and of no known solid.
  std::string new_id(const std::string& type) {
    std::string id;
    do {
      id = fmt::format("{}_{}", type, numbers_[type]++);
    } while (ids_.contains(id));
    return id;
  }

  std::size_t known_;
  std::set<std::string> ids_;  // of known solids
  std::vector<std::tuple<TermPart, Overshoots, bool>> parts_;
  std::map<std::string, std::size_t> numbers_;
};

}  // namespace

WrittenSolids write_solids(const TermSpace& space, DecisionList list) {
  Ends ends(space, list);
  for (std::size_t r = 0; r < list.size(); ++r) {
    for (std::size_t p = 0; p < list[r].term.parts.size(); ++p) ends.draw_in(r, p);
  }
  SolidWriter writer(space.known);
  std::vector<CsgTree> terms;
  for (std::size_t r = 0; r < list.size(); ++r) {
    std::optional<CsgTree> term;
    for (std::size_t p = 0; p < list[r].term.parts.size(); ++p) {
      const TermPart part = list[r].term.parts[p];
      const CsgTree leaf =
          CsgTree::leaf(writer.add(space, part, ends.overshoots(r, p), list[r].is_in != part.is_inverted));
      term = !term ? leaf : part.is_inverted ? subtract(*term, leaf) : intersect(*term, leaf);
    }
    terms.push_back(*term);
  }
  CsgTree tree;
  for (std::size_t r = list.size(); r-- > 0;) {
    tree = list[r].is_in ? unite(tree, terms[r]) : subtract(tree, terms[r]);
  }
  return {.solids = std::move(writer.solids), .tree = simplify(tree)};
}

}  // namespace cloud2csg
