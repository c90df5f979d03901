#include "raw/solids/term_space.hpp"

#include <algorithm>
#include <numeric>

#include "core/tree/interner.hpp"
#include "raw/solids/edges.hpp"

namespace cloud2csg {
namespace {

constexpr double k_derived_share = 0.006;  // in diagonals: possible error of edges from round surfaces
constexpr double k_part_margin = 0.02;     // in diagonals: less than the places' margin
constexpr double k_margin = 1.0;           // in diagonals: unbounded terms cover everything

std::vector<PlaneFamily> distinct_planes(std::span<const DetectedSurface> surfaces, double tolerance,
                                         const Eigen::Vector3d& middle) {
  std::vector<PlaneFamily> planes;
  for (const DetectedSurface& detected : surfaces) {
    const Surface& surface = detected.surface;
    if (surface.type != SurfaceType::plane) continue;
    const bool is_known = std::ranges::any_of(planes, [&](const PlaneFamily& plane) {
      return are_parallel(plane.normal, surface.axis) &&
             std::abs(plane.normal.dot(surface.position - middle) - (plane.offset - plane.normal.dot(middle))) <
                 tolerance;
    });
    if (is_known) continue;
    planes.push_back({.normal = surface.axis, .offset = surface.axis.dot(surface.position), .is_under = {}});
  }
  return planes;
}

bool is_of_frame(const PlaneFamily& plane, const BoxFamily& boxes) {
  return are_parallel(plane.normal, boxes.axes.col(0)) || are_parallel(plane.normal, boxes.axes.col(1)) ||
         are_parallel(plane.normal, boxes.axes.col(2));
}

void bin_places(BoxFamily& boxes, const Points& positions) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = boxes.axes.col(static_cast<Eigen::Index>(axis));
    boxes.bin_of_place[axis].resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      boxes.bin_of_place[axis][i] = boxes.bins[axis].bin_of(positions[i].dot(direction));
    }
  }
}

void bin_places(RevolvedFamily& revolved, const Primitive& known, const Points& positions) {
  const std::vector<double> distances = signed_distance(known, positions);
  revolved.is_inside.assign(positions.size(), 0);
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (!(distances[i] < 0)) continue;
    revolved.is_inside[i] = 1;
    revolved.inside.push_back(i);
    revolved.bin_of_inside.push_back(0);
  }
}

void bin_places(RevolvedFamily& revolved, const Points& positions) {
  const Surface& surface = revolved.surface;
  revolved.is_inside.resize(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const bool is_in_material = signed_distance(surface, positions[i]) < 0;
    revolved.is_inside[i] = is_in_material != surface.concave ? 1 : 0;
    if (revolved.is_inside[i] == 0) continue;
    revolved.inside.push_back(i);
    revolved.bin_of_inside.push_back(revolved.bins.bin_of((positions[i] - surface.position).dot(surface.axis)));
  }
}

void bin_places(PlaneFamily& plane, const Points& positions) {
  plane.is_under.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    plane.is_under[i] = plane.normal.dot(positions[i]) <= plane.offset ? 1 : 0;
  }
}

void bin_places(TermSpace& space, const Points& positions) {
  for (BoxFamily& boxes : space.boxes) bin_places(boxes, positions);
  for (RevolvedFamily& revolved : space.revolved) {
    revolved.inside.clear();
    revolved.bin_of_inside.clear();
    if (revolved.known) {
      bin_places(revolved, space.known[*revolved.known], positions);
    } else {
      bin_places(revolved, positions);
    }
  }
  for (PlaneFamily& plane : space.planes) bin_places(plane, positions);
}

/// A number for each place, equal for places that no family distinguishes.
std::vector<std::uint32_t> kinds_of_places(const TermSpace& space, std::size_t count) {
  std::vector<std::vector<std::uint32_t>> axial(space.revolved.size(), std::vector<std::uint32_t>(count, 0));
  for (std::size_t r = 0; r < space.revolved.size(); ++r) {
    const RevolvedFamily& revolved = space.revolved[r];
    for (std::size_t k = 0; k < revolved.inside.size(); ++k)
      axial[r][revolved.inside[k]] = 1U + revolved.bin_of_inside[k];
  }
  Interner kinds;
  std::vector<std::uint32_t> kind_of(count);
  std::vector<std::uint32_t> key;
  for (std::size_t i = 0; i < count; ++i) {
    key.clear();
    for (const BoxFamily& boxes : space.boxes) {
      for (const std::vector<std::uint16_t>& bins : boxes.bin_of_place) key.push_back(bins[i]);
    }
    for (const std::vector<std::uint32_t>& bins : axial) key.push_back(bins[i]);
    for (const PlaneFamily& plane : space.planes) key.push_back(plane.is_under[i]);
    kind_of[i] = kinds.intern(key);
  }
  return kind_of;
}

std::vector<BoxFamily> box_families(std::span<const DetectedSurface> surfaces, const EdgeRules& rules) {
  std::vector<BoxFamily> families;
  for (const Eigen::Matrix3d& axes : orthogonal_frames(surfaces)) {
    BoxFamily& boxes = families.emplace_back();
    boxes.axes = axes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes.bins[axis] = edges_along(axes.col(static_cast<Eigen::Index>(axis)), surfaces, rules);
    }
  }
  return families;
}

std::vector<RevolvedFamily> known_families(std::size_t count, double diagonal) {
  std::vector<RevolvedFamily> families(count);
  for (std::size_t k = 0; k < count; ++k) {
    families[k].known = static_cast<PrimitiveIndex>(k);
    families[k].bins.edges = {-diagonal, diagonal};
  }
  return families;
}

RevolvedFamily revolved_family(const DetectedSurface& detected, const Points& positions,
                               std::span<const DetectedSurface> surfaces, const EdgeRules& rules, double diagonal) {
  RevolvedFamily family;
  family.surface = detected.surface;
  const bool has_ends = detected.surface.type == SurfaceType::cylinder || detected.surface.type == SurfaceType::cone;
  family.bins =
      has_ends ? edges_along_axis(detected, positions, surfaces, rules) : Bins{.edges = {-diagonal, diagonal}};
  return family;
}

/// Bins the places and merges those that nothing distinguishes.
void join_places(TermSpace& space, const LabelledPlaces& places) {
  bin_places(space, places.positions);
  const std::vector<std::uint32_t> kinds = kinds_of_places(space, places.positions.size());
  Points first_of_kind;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (kinds[i] == space.pulls.size()) {
      space.pulls.push_back(0);
      first_of_kind.push_back(places.positions[i]);
    }
    space.pulls[kinds[i]] += places.weights[i];
  }
  for (double& pull : space.pulls) pull = summable(pull);
  bin_places(space, first_of_kind);
  for (std::size_t i = 0; i < space.size(); ++i) {
    for (const RevolvedFamily& revolved : space.revolved) space.is_inside.push_back(revolved.is_inside[i]);
  }
}

}  // namespace

std::uint16_t Bins::bin_of(double value) const {
  const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
  return static_cast<std::uint16_t>(above - (edges.begin() + 1));
}

TermSpace make_term_space(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                          const LabelledPlaces& places, double distance_tolerance, const KnownTerms& known) {
  const AlignedBox box = bounds_of(cloud.positions);
  const double diagonal = box.diagonal().norm();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(k_margin * diagonal);
  const Eigen::Vector3d slack = Eigen::Vector3d::Constant(k_part_margin * diagonal);
  TermSpace space;
  space.known = known.solids;
  space.part_bounds = AlignedBox(box.min() - slack, box.max() + slack);
  space.bounds = AlignedBox(box.min() - margin, box.max() + margin);
  const EdgeRules rules{.bounds = space.bounds,
                        .plane_tolerance = distance_tolerance,
                        .derived_tolerance = std::max(2 * distance_tolerance, k_derived_share * diagonal)};
  std::vector<DetectedSurface> all = known.surfaces;
  all.insert(all.end(), surfaces.begin(), surfaces.end());
  space.boxes = box_families(all, rules);
  space.revolved = known_families(known.solids.size(), diagonal);
  for (const DetectedSurface& detected : surfaces) {
    if (detected.surface.type == SurfaceType::plane) continue;
    space.revolved.push_back(revolved_family(detected, cloud.positions, all, rules, diagonal));
  }
  space.planes = distinct_planes(all, distance_tolerance, box.center());
  for (const PlaneFamily& plane : space.planes) {
    space.has_oblique_planes = space.has_oblique_planes || !is_of_frame(plane, space.boxes[0]);
  }
  if (!space.has_oblique_planes) space.planes.clear();
  join_places(space, places);
  return space;
}

std::vector<std::uint8_t> members_of(const TermSpace& space, const Term& term) {
  std::vector<std::uint8_t> members(space.size(), 1);
  for (const TermPart& part : term.parts) {
    std::vector<std::uint8_t> inside(space.size(), part.kind == PartKind::revolved ? 0 : 1);
    if (part.kind == PartKind::box) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint16_t>& bins = space.boxes[part.family].bin_of_place[axis];
        const BinRange range = part.ranges[axis];
        for (std::size_t i = 0; i < inside.size(); ++i) {
          inside[i] &= static_cast<std::uint8_t>(bins[i] >= range.first && bins[i] <= range.last);
        }
      }
    } else if (part.kind == PartKind::revolved) {
      const RevolvedFamily& revolved = space.revolved[part.family];
      for (std::size_t k = 0; k < revolved.inside.size(); ++k) {
        const std::uint16_t bin = revolved.bin_of_inside[k];
        if (bin >= part.ranges[0].first && bin <= part.ranges[0].last) inside[revolved.inside[k]] = 1;
      }
    } else {
      for (const std::uint32_t side : part.planes) {
        const std::vector<std::uint8_t>& under = space.planes[side / 2].is_under;
        for (std::size_t i = 0; i < inside.size(); ++i) {
          inside[i] &= static_cast<std::uint8_t>((under[i] != 0) != (side % 2 != 0));
        }
      }
    }
    for (std::size_t i = 0; i < members.size(); ++i)
      members[i] &= static_cast<std::uint8_t>((inside[i] != 0) != part.is_inverted);
  }
  return members;
}

}  // namespace cloud2csg
