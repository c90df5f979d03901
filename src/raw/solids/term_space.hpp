#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "raw/solids/max_sum.hpp"

namespace cloud2csg {

/// Bin i lies between the sorted edges i and i + 1. The first and last bin include everything beyond the ends.
struct Bins {
  std::vector<double> edges = {};

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(edges.size() - 1); }
  [[nodiscard]] std::uint16_t bin_of(double value) const;
};

/// Three orthogonal directions, and possible faces of boxes along each. The first and last edge are beyond the part.
struct BoxFamily {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, right-handed
  std::array<Bins, 3> bins = {};
  std::array<std::vector<std::uint16_t>, 3> bin_of_place = {};
};

/// A curved surface, or a known solid of any shape. A cylinder's or cone's edges cut its axis; others have one bin.
struct RevolvedFamily {
  Surface surface = {};
  std::optional<PrimitiveIndex> known = {};  ///< index into `TermSpace::known`; then `surface` has no meaning
  Bins bins = {};
  std::vector<std::uint32_t> inside = {};         ///< places, ascending
  std::vector<std::uint16_t> bin_of_inside = {};  ///< one for each entry of `inside`
  std::vector<std::uint8_t> is_inside = {};       ///< by place
};

/// A plane of either orientation. Coplanar planes are one.
struct PlaneFamily {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0;
  std::vector<std::uint8_t> is_under = {};  ///< by place: normal . x <= offset
};

/// Rounded to a multiple of 2^-40, so that sums are exact in any order. Terms of the same places then gain exactly the
/// same, and the first of them is taken, not the one that rounding favours.
[[nodiscard]] inline double summable(double pull) {
  constexpr double k_quantum = 0x1p-40;  // of a total of about 2
  return std::round(pull / k_quantum) * k_quantum;
}

/// Places that no surface distinguishes are merged, and their weights added.
struct TermSpace {
  PrimitiveSet known = {};         ///< solids that terms may use
  std::vector<double> pulls = {};  ///< by place: gain from having it in the solid; summable()
  std::vector<BoxFamily> boxes = {};
  std::vector<RevolvedFamily> revolved = {};
  std::vector<std::uint8_t> is_inside = {};  ///< a row a place: which curved surfaces contain it
  std::vector<PlaneFamily> planes = {};
  bool has_oblique_planes = false;  ///< some that belong to no box family
  AlignedBox part_bounds = {};      ///< slightly beyond the part: limit of added solids
  AlignedBox bounds = {};           ///< far beyond the part on all sides

  [[nodiscard]] std::size_t size() const { return pulls.size(); }
};

/// Known solids, and their surfaces, at which other solids may end.
struct KnownTerms {
  PrimitiveSet solids = {};
  std::vector<DetectedSurface> surfaces = {};
};

/// O(places x surfaces).
[[nodiscard]] TermSpace make_term_space(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        const LabelledPlaces& places, double distance_tolerance,
                                        const KnownTerms& known = {});

enum class PartKind : std::uint8_t { box, revolved, polytope };

struct TermPart {
  PartKind kind = PartKind::box;
  std::uint32_t family = 0;                ///< index of the box family or curved surface
  std::array<BinRange, 3> ranges = {};     ///< for a box; the first is the range along a curved surface's axis
  std::vector<std::uint32_t> planes = {};  ///< for a polytope: 2 * plane, plus 1 for the side above it
  bool is_inverted = false;                ///< the outside
  bool is_known = false;
  friend bool operator==(const TermPart&, const TermPart&) = default;
};

/// The intersection of its one or two parts. The first is not inverted.
struct Term {
  std::vector<TermPart> parts = {};
  friend bool operator==(const Term&, const Term&) = default;
};

/// By place: 1 in the term. O(places x parts).
[[nodiscard]] std::vector<std::uint8_t> members_of(const TermSpace& space, const Term& term);

}  // namespace cloud2csg
