#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

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
