#include "raw/solids/write_solids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

constexpr double k_most_overshoot = 0.01;  // in diagonals of the bounds, which are far out

/// By part, side and end: whether an end moves into a bin that makes no difference.
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

void set_term(const TermSpace& space, Rule& rule, const Term& term) {
  rule.term = term;
  rule.members = members_of(space, term);
}

/// Moves the ends of all parts inward as long as the list decides all places as before.
class DrawnIn {
 public:
  static DecisionList of(const TermSpace& space, DecisionList list) {
    DrawnIn drawn(space, std::move(list));
    for (std::size_t r = 0; r < drawn.list_.size(); ++r) {
      for (std::size_t p = 0; p < drawn.list_[r].term.parts.size(); ++p) drawn.draw_in(r, p);
    }
    return std::move(drawn.list_);
  }

 private:
  DrawnIn(const TermSpace& space, DecisionList list)
      : space_(space), list_(std::move(list)), wanted_(decisions_of(list_, space.size())) {}

  void draw_in(std::size_t rule, std::size_t part) {
    for (std::size_t side = 0; side < sides_of(list_[rule].term.parts[part]); ++side) {
      while (try_shorter(rule, part, side, 1, 0)) {
      }
      while (try_shorter(rule, part, side, 0, 1)) {
      }
    }
  }

  bool try_shorter(std::size_t rule, std::size_t part, std::size_t side, std::uint32_t at_first,
                   std::uint32_t at_last) {
    const Term kept = list_[rule].term;
    Term moved = kept;
    BinRange& range = moved.parts[part].ranges[side];
    if (range.first == range.last) return false;
    range = {range.first + at_first, range.last - at_last};
    set_term(space_, list_[rule], moved);
    if (decisions_of(list_, space_.size()) == wanted_) return true;
    set_term(space_, list_[rule], kept);
    return false;
  }

  const TermSpace& space_;
  DecisionList list_;
  std::vector<std::uint8_t> wanted_;
};

/// Finds ends that may lie anywhere in the next bin. Any choice of such ends must leave all decisions unchanged. So a
/// place that enters or leaves one rule's term must not depend on that rule, nor enter or leave another rule's term.
class FreeEnds {
 public:
  /// By rule and part.
  static std::vector<std::vector<Overshoots>> of(const TermSpace& space, const DecisionList& list) {
    FreeEnds ends(space, list);
    std::vector<std::vector<Overshoots>> result;
    for (std::size_t r = 0; r < list.size(); ++r) {
      const std::vector<std::uint8_t> is_free = ends.places_that_do_not_depend_on(r);
      std::vector<Overshoots>& of_parts = result.emplace_back(list[r].term.parts.size());
      for (std::size_t p = 0; p < of_parts.size(); ++p) {
        for (std::size_t side = 0; side < sides_of(list[r].term.parts[p]); ++side) {
          for (std::size_t end = 0; end < 2; ++end) of_parts[p][side][end] = ends.free(r, p, side, end, is_free);
        }
      }
    }
    return result;
  }

 private:
  FreeEnds(const TermSpace& space, const DecisionList& list) : space_(space), list_(list), owners_(space.size(), 0) {
    for (const Rule& rule : list) longest_.push_back(rule.term);
  }

  [[nodiscard]] std::vector<std::uint8_t> places_that_do_not_depend_on(std::size_t rule) const {
    DecisionList list = list_;
    list[rule].members.assign(space_.size(), 1);
    std::vector<std::uint8_t> result = decisions_of(list, space_.size());
    list[rule].members.assign(space_.size(), 0);
    const std::vector<std::uint8_t> without = decisions_of(list, space_.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = result[i] == without[i] ? 1 : 0;
    return result;
  }

  bool free(std::size_t rule, std::size_t part, std::size_t side, std::size_t end,
            const std::vector<std::uint8_t>& is_free) {
    const TermPart& exact = list_[rule].term.parts[part];
    const BinRange range = exact.ranges[side];
    if (end == 0 ? range.first == 0 : range.last + 1 == bins_of(space_, exact, side).count()) return false;
    TermPart moved = exact;
    lengthen(moved.ranges[side], end);
    if (!reaches_other_places(exact, moved)) return false;
    Term longer = longest_[rule];
    lengthen(longer.parts[part].ranges[side], end);
    const std::vector<std::uint32_t> changing = places_that_change(list_[rule].term, longer);
    for (const std::uint32_t i : changing) {
      if (is_free[i] == 0 || (owners_[i] != 0 && owners_[i] != rule + 1)) return false;
    }
    for (const std::uint32_t i : changing) owners_[i] = static_cast<std::uint32_t>(rule + 1);
    longest_[rule] = std::move(longer);
    return true;
  }

  static void lengthen(BinRange& range, std::size_t end) {
    if (end == 0)
      --range.first;
    else
      ++range.last;
  }

  /// Places whose membership in the term depends on the lengths of its parts.
  [[nodiscard]] std::vector<std::uint32_t> places_that_change(const Term& exact, const Term& longest) const {
    Term most = longest;
    Term least = exact;
    for (std::size_t p = 0; p < exact.parts.size(); ++p) {
      if (exact.parts[p].is_inverted) std::swap(most.parts[p], least.parts[p]);
    }
    const std::vector<std::uint8_t> in_most = members_of(space_, most);
    const std::vector<std::uint8_t> in_least = members_of(space_, least);
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < in_most.size(); ++i) {
      if (in_most[i] != in_least[i]) places.push_back(i);
    }
    return places;
  }

  /// Nothing is known about a bin without places.
  [[nodiscard]] bool reaches_other_places(TermPart a, TermPart b) const {
    a.is_inverted = false;
    b.is_inverted = false;
    return members_of(space_, {.parts = {a}}) != members_of(space_, {.parts = {b}});
  }

  const TermSpace& space_;
  const DecisionList& list_;
  std::vector<Term> longest_;          ///< by rule, with all free ends one bin farther
  std::vector<std::uint32_t> owners_;  ///< by place: the rule, from 1, whose term it may enter or leave
};

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

/// Whether flipping the solid reduces its rotation.
bool is_upside_down(const Eigen::Vector3d& axis) {
  constexpr double k_level = 1e-9;
  for (const Eigen::Index k : {2, 1, 0}) {
    if (std::abs(axis[k]) > k_level) return axis[k] < 0;
  }
  return false;
}

Primitive revolved_solid(const Surface& surface, const Span& span) {
  const Eigen::Vector3d middle = surface.position + 0.5 * (span.low + span.high) * surface.axis;
  const double height = span.high - span.low;
  const bool is_turned = is_upside_down(surface.axis);
  const Eigen::Vector3d axis = is_turned ? -surface.axis : surface.axis;
  switch (surface.type) {
    case SurfaceType::cylinder:
      return {.id = {}, .shape = Cylinder{surface.radius, height}, .pose = pose_from_axis(middle, axis)};
    case SurfaceType::cone: {
      const double slope = std::tan(surface.half_angle);
      Cone cone{.radius_bottom = std::max(slope * span.low, 0.0), .radius_top = slope * span.high, .height = height};
      if (is_turned) std::swap(cone.radius_bottom, cone.radius_top);
      return {.id = {}, .shape = cone, .pose = pose_from_axis(middle, axis)};
    }
    case SurfaceType::torus:
      return {.id = {},
              .shape = Torus{surface.radius, surface.minor_radius},
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

/// The planes with at least three corners, relative to the middle of all corners.
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
  // Too far from the origin, rounding hides the corners. Keeps all planes, because a solid needs some.
  if (needed.planes.size() < 4) return {.id = {}, .shape = std::move(all), .pose = {}};
  return {.id = {}, .shape = std::move(needed), .pose = {.position = middle}};
}

/// Solids that add to the part end with it. Solids that subtract reach beyond all those.
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

  /// A box around the part. It is the last solid, because indices are counted from the first one that was added.
  PrimitiveIndex add_part_box(const TermSpace& space) {
    Primitive box{.id = {}, .shape = Box{space.part_bounds.sizes()}, .pose = {.position = space.part_bounds.center()}};
    box.id = new_id(std::string(type_name(box.shape)));
    solids.push_back(std::move(box));
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

  std::size_t known_;
  std::set<std::string> ids_;
  std::vector<std::tuple<TermPart, Overshoots, bool>> parts_;
  std::map<std::string, std::size_t> numbers_;
};

/// A rule's term as a tree, and where it may be.
struct WrittenTerm {
  CsgTree tree = {};
  AlignedBox reach = everywhere();
};

WrittenTerm write_term(const TermSpace& space, const Rule& rule, const std::vector<Overshoots>& overshoots,
                       SolidWriter& writer) {
  WrittenTerm term;
  for (std::size_t p = 0; p < rule.term.parts.size(); ++p) {
    const TermPart& part = rule.term.parts[p];
    const PrimitiveIndex solid = writer.add(space, part, overshoots[p], rule.is_in != part.is_inverted);
    const CsgTree leaf = CsgTree::leaf(solid);
    term.tree = p == 0 ? leaf : part.is_inverted ? subtract(term.tree, leaf) : intersect(term.tree, leaf);
    if (!part.is_inverted) term.reach = term.reach.intersection(bounds(writer.solids[solid]));
  }
  return term;
}

}  // namespace

WrittenSolids write_solids(const TermSpace& space, DecisionList list) {
  list = DrawnIn::of(space, std::move(list));
  const std::vector<std::vector<Overshoots>> overshoots = FreeEnds::of(space, list);
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
    const CsgTree part_box = CsgTree::leaf(writer.add_part_box(space));
    for (const std::size_t r : endless) terms[r] = intersect(terms[r], part_box);
  }
  CsgTree tree;
  for (std::size_t r = list.size(); r-- > 0;) {
    tree = list[r].is_in ? unite(tree, terms[r]) : subtract(tree, terms[r]);
  }
  return {.solids = std::move(writer.solids), .tree = simplify(tree)};
}

}  // namespace cloud2csg
