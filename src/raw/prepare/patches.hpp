#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// The area of each point, without neighbours across a wall or gap: they make thin walls too light. O(n width)
[[nodiscard]] std::vector<double> surface_areas(const Points& places, const Points& normals,
                                                const NeighbourTable& neighbours, double noise);

/// Small, nearly flat pieces of surface. Each point also agrees with its patch's seed, so normals certainly agree.
struct Patches {
  static constexpr std::uint32_t k_none = UINT32_MAX;
  std::vector<std::uint32_t> of_point;             ///< patch of each point, or k_none
  std::vector<char> flipped;                       ///< whether a point's normal is opposite to its patch's
  std::vector<std::vector<std::uint32_t>> points;  ///< by patch
};

/// Grows patches of at most `most` points along neighbours and drops those with fewer than `least`. Two points are on
/// one surface if their normals are alike up to sign and the step between them lies in the surface within the angle
/// between the normals, which excludes the other side of a wall. O(n width)
[[nodiscard]] Patches grow_patches(const Points& places, const Points& normals, const NeighbourTable& neighbours,
                                   double noise, std::size_t least, std::size_t most);

/// Disjoint sets whose members have a sign relative to each other.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parents_(count), flipped_(count, 0), sizes_(count, 1) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }

  struct Member {
    std::uint32_t root;
    bool is_flipped;  ///< sign opposite to the root's
  };
  /// Compresses the path to the root. Amortised O(log n)
  Member find(std::uint32_t item) {
    std::uint32_t root = item;
    bool is_flipped = false;
    while (parents_[root] != root) {
      is_flipped = is_flipped != (flipped_[root] != 0);
      root = parents_[root];
    }
    bool rest = is_flipped;
    while (parents_[item] != root && item != root) {
      const std::uint32_t next = parents_[item];
      const bool own = flipped_[item] != 0;
      parents_[item] = root;
      flipped_[item] = rest ? 1 : 0;
      rest = rest != own;
      item = next;
    }
    return {root, is_flipped};
  }

  /// Joins the sets of two items with equal or opposite signs. No effect within one set.
  void join(std::uint32_t one, std::uint32_t other, bool are_opposite) {
    Member a = find(one);
    Member b = find(other);
    if (a.root == b.root) return;
    if (sizes_[a.root] < sizes_[b.root]) std::swap(a, b);
    parents_[b.root] = a.root;
    flipped_[b.root] = (a.is_flipped != b.is_flipped) != are_opposite ? 1 : 0;
    sizes_[a.root] += sizes_[b.root];
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<char> flipped_;
  std::vector<std::uint32_t> sizes_;
};

/// Sum of votes across the border of two patches; positive if they are oriented alike.
struct PatchVote {
  std::uint32_t one, other;  ///< one < other
  double votes;
};

/// The winding number of each patch at the places of all patches.
struct PatchFields {
  std::size_t count = 0;
  std::vector<float> values;  ///< [source x count + place]

  [[nodiscard]] std::span<const float> of(std::size_t source) const {
    return std::span(values).subspan(source * count, count);
  }
};

struct PatchSigns {
  std::vector<char> flipped;           ///< patches to flip
  std::vector<double> windings;        ///< winding number at each patch; one half if all is right
  std::vector<std::uint32_t> body_of;  ///< by patch; votes join the patches of a body
};

/// Finds the patches to flip so that the winding number, averaged over both sides, is one half at each patch (weighted
/// by `weights`) and borders agree. The clearest votes join patches into a hierarchy of groups, which flip while that
/// gains: the best first, then any. Each pair occurs once in `votes`. O(patches^2) a round. @throws Cancelled
[[nodiscard]] PatchSigns find_patch_signs(const PatchFields& fields, std::span<const double> weights,
                                          std::span<const PatchVote> votes, const RunContext& run);

}  // namespace cloud2csg
