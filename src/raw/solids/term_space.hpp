#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "raw/solids/charts.hpp"
#include "raw/solids/max_sum.hpp"

namespace cloud2csg {

/// Bin i lies between the sorted edges i and i + 1. The first and last bin include everything beyond the ends.
struct Bins {
  std::vector<double> edges = {};

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(edges.size() - 1); }
  [[nodiscard]] std::uint16_t bin_of(double value) const;
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

/// Extrusions or revolutions: sets of a drawing's faces. Extrusions and sectors end at two of the slabs' edges.
struct ProfileFamily {
  Chart chart = {};
  Bins slabs = {};        ///< of heights, or of angles
  double bare_price = 0;  ///< leaves that a unit of the drawing's prices costs, times the height or share of a turn
  std::vector<std::uint32_t> face_of_place = {};
  std::vector<std::uint16_t> slab_of_place = {};

  /// Height, or share of a full turn.
  [[nodiscard]] double size_of(BinRange range) const;
  /// Whether revolutions of this range are less than a full turn.
  [[nodiscard]] bool is_sector(BinRange range) const {
    return chart.is_turned && range.last - range.first + 1 < slabs.count();
  }
};

/// Rounded to a multiple of 2^-40, so that sums are exact in any order. Terms of the same places then gain exactly the
/// same, and the first of them is taken, not the one that rounding favours.
[[nodiscard]] inline double summable(double pull) {
  constexpr double k_quantum = 0x1p-40;  // of a total of about 2
  return std::round(pull / k_quantum) * k_quantum;
}

/// What terms are made of. Places that no surface distinguishes are merged, and their weights added.
struct TermSpace {
  PrimitiveSet known = {};         ///< solids that terms may use
  std::vector<double> pulls = {};  ///< by place: gain from having it in the solid; summable()
  std::vector<RevolvedFamily> revolved = {};
  std::vector<PlaneFamily> planes = {};
  std::vector<ProfileFamily> profiles = {};
  AlignedBox part_bounds = {};  ///< of the points on surfaces: added solids that nothing else ends end there
  AlignedBox part_limits = {};  ///< slightly beyond: corners of added solids may reach as far
  AlignedBox bounds = {};       ///< far beyond the part on all sides

  [[nodiscard]] std::size_t size() const { return pulls.size(); }
};

/// What terms may use beside the found surfaces: known solids, and their surfaces, at which other solids may end.
struct KnownTerms {
  PrimitiveSet solids = {};
  std::vector<DetectedSurface> surfaces = {};
};

/// The families, without places yet. Costs what make_charts() costs.
[[nodiscard]] TermSpace make_term_space(const Points& positions, std::span<const DetectedSurface> surfaces,
                                        const ChartOptions& options, const KnownTerms& known = {});

/// The space with these places, and with more planes, which need be no faces. O(places x surfaces)
[[nodiscard]] TermSpace with_places(TermSpace space, const LabelledPlaces& places,
                                    std::span<const Surface> separators = {});

enum class PartKind : std::uint8_t { revolved, polytope, profile };

struct TermPart {
  PartKind kind = PartKind::polytope;
  std::uint32_t family = 0;  ///< index of the curved surface or profile family
  BinRange range = {};       ///< along a curved surface's axis, or of slabs
  std::vector<std::uint32_t> planes =
      {};                    ///< for a polytope: 2 * plane, plus 1 for the side above it; none: everything
  FaceSet faces = {};        ///< for a profile
  std::size_t segments = 0;  ///< of the profile
  double bare_leaves = 0;    ///< price of a profile's surfaces where no points are
  bool is_inverted = false;  ///< the outside
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
