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

/// The surface that each point stands for. Neighbours count as far as they are not on the other side of a wall or gap:
/// those would make thin walls too light. O(n width)
[[nodiscard]] std::vector<double> surface_areas(const Points& places, const Points& normals,
                                                const NeighbourTable& neighbours, double noise);

/// Small pieces of a surface, each nearly flat: within one the normals agree for sure, as each of its points is held
/// against its first point, not against the one that led to it.
struct Patches {
  static constexpr std::uint32_t k_none = UINT32_MAX;
  std::vector<std::uint32_t> of_point;             ///< the patch of each point, k_none where it is in none
  std::vector<char> flipped;                       ///< of each point: its normal is opposite to those of its patch
  std::vector<std::vector<std::uint32_t>> points;  ///< of each patch
};

/// Grows patches of at most `most` points along neighbours; those of fewer than `least` points are left out. Two
/// points are on one piece of surface when their normals, up to the sign, are alike, and the step between them lies in
/// the surface as far as the angle between the normals tells: the other side of a wall does not. O(n width)
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
    bool is_flipped;  ///< its sign is opposite to the root's
  };
  /// Shortens the way to the root. Amortised O(log n)
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

  /// Joins the sets of two items, the signs of which are equal or opposite. Nothing when they are in one set.
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

/// What a vote of neighbours across the border of two patches says: positive, they are oriented alike.
struct PatchVote {
  std::uint32_t one, other;  ///< one < other
  double votes;
};

/// The field of each patch at each other one: columns of winding numbers.
struct PatchFields {
  std::size_t count = 0;
  std::vector<float> values;  ///< [source x count + place]

  [[nodiscard]] std::span<const float> of(std::size_t source) const {
    return std::span(values).subspan(source * count, count);
  }
};

struct PatchSigns {
  std::vector<char> flipped;           ///< patches to turn
  std::vector<double> windings;        ///< the winding number at each patch: one half where all is right
  std::vector<std::uint32_t> body_of;  ///< of each patch: those that votes join are of one body
};

/// Which patches to turn so that the winding number, the mean of both sides, is one half at all of them, weighted by
/// `weights`, and their borders agree. Patches are joined one by one by the clearest votes; all the groups that so come
/// to be, from single patches to all, are turned as long as that makes the result better: the best first, then any.
/// Each pair of patches occurs once in `votes`. O(patches^2) a round
/// @throws Cancelled
[[nodiscard]] PatchSigns find_patch_signs(const PatchFields& fields, std::span<const double> weights,
                                          std::span<const PatchVote> votes, const RunContext& run);

}  // namespace cloud2csg
