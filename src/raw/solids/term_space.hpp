#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "raw/solids/max_sum.hpp"

/// What terms are made of: places, binned by all surfaces.
namespace cloud2csg {

/// Of sorted edges: bin i lies between edges i and i + 1. What is beyond the ends counts to the first or last bin.
struct Bins {
  std::vector<double> edges = {};

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(edges.size() - 1); }
  [[nodiscard]] std::uint16_t bin_of(double value) const;
};

/// Three orthogonal directions and where faces of boxes may lie along them. The first and last edge are beyond the
/// part.
struct BoxFamily {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, right-handed
  std::array<Bins, 3> bins = {};
  std::array<std::vector<std::uint16_t>, 3> bin_of_place = {};
};

/// A curved surface, and where a cylinder or cone may be cut along its axis; the others have one bin. Or a solid that
/// is known, of any shape, which is as it is and has one bin, too.
struct RevolvedFamily {
  Surface surface = {};
  std::optional<PrimitiveIndex> known = {};  ///< of the space's known solids; then the surface has no meaning
  Bins bins = {};
  std::vector<std::uint32_t> inside = {};         ///< places, ascending
  std::vector<std::uint16_t> bin_of_inside = {};  ///< one for each of these
  std::vector<std::uint8_t> is_inside = {};       ///< by place
};

/// A plane, whichever way it was found: coplanar ones are one.
struct PlaneFamily {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
  std::vector<std::uint8_t> is_under = {};  ///< by place: normal . x <= offset
};

/// Places that all surfaces tell nothing apart are one, with the sum of their weights.
struct TermSpace {
  PrimitiveSet known = {};         ///< solids that are there to be used
  std::vector<double> pulls = {};  ///< by place: what there is to gain by having it in the solid
  std::vector<BoxFamily> boxes = {};
  std::vector<RevolvedFamily> revolved = {};
  std::vector<std::uint8_t> is_inside = {};  ///< a row for each place: of which curved surfaces it is inside
  std::vector<PlaneFamily> planes = {};
  bool has_oblique_planes = false;  ///< some that are not those of one box family
  AlignedBox part_bounds = {};      ///< a little beyond the part: what adds to it ends here at the latest
  AlignedBox bounds = {};           ///< far beyond the part on all sides

  [[nodiscard]] std::size_t size() const { return pulls.size(); }
};

/// Solids that are known, and their surfaces: at these others may end.
struct KnownTerms {
  PrimitiveSet solids = {};
  std::vector<DetectedSurface> surfaces = {};
};

/// O(places x surfaces).
[[nodiscard]] TermSpace make_term_space(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        const LabelledPlaces& places, double distance_tolerance,
                                        const KnownTerms& known = {});

enum class PartKind : std::uint8_t { box, revolved, polytope };

/// One solid of a term.
struct TermPart {
  PartKind kind = PartKind::box;
  std::uint32_t family = 0;                ///< of the box or curved surface
  std::array<BinRange, 3> ranges = {};     ///< of a box; the first is the range along the axis of a curved surface
  std::vector<std::uint32_t> planes = {};  ///< of a polytope: 2 * plane, plus 1 for what is above it
  bool is_inverted = false;                ///< what is outside of it
  bool is_known = false;                   ///< a known solid
  friend bool operator==(const TermPart&, const TermPart&) = default;
};

/// What its parts have in common: one solid, or two. The first is not inverted.
struct Term {
  std::vector<TermPart> parts = {};
  friend bool operator==(const Term&, const Term&) = default;
};

/// By place: 1 in the term. O(places x parts).
[[nodiscard]] std::vector<std::uint8_t> members_of(const TermSpace& space, const Term& term);

}  // namespace cloud2csg
