#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/solids/arrangement.hpp"

namespace cloud2csg {

/// The faces of a drawing, and what a border along its edges costs.
struct Drawing {
  bool is_turned = false;  ///< about x = 0
  CurveArrangement arrangement;
  std::vector<std::uint32_t> curve_of_edge;  ///< edges of one curve go on without a corner
  std::vector<double> price_of_edge;         ///< of a border there: where no points are, say
};

/// By face: whether it belongs to a region. Face 0, outside the drawing, never does.
using FaceSet = std::vector<std::uint8_t>;

/// Segments of the region's border: maximal parts of one curve. O(edges)
[[nodiscard]] std::size_t segments_of(const Drawing& drawing, const FaceSet& faces);

/// Price of the edges at the region's border. O(edges)
[[nodiscard]] double border_price(const Drawing& drawing, const FaceSet& faces);

/// Sum of the gains of the faces, less the price of the border's edges and segments. O(edges)
[[nodiscard]] double net_gain(const Drawing& drawing, std::span<const double> gains, double price_of_segment,
                              const FaceSet& faces);

/// A set of faces with a large net gain; `gains` has one entry a face. A minimum cut (Boykov and Kolmogorov 2004) finds
/// the best set for the edges' prices. Corners have no such exact method, so faces at the border then change sides
/// while that gains. At last, faces change sides where the border touches itself or the axis in a single point, since
/// no profile may do so; where that is not possible, the point stays. A stop ends the changes early. O(faces x edges)
/// in practice
[[nodiscard]] FaceSet choose_faces(const Drawing& drawing, std::span<const double> gains, double price_of_segment,
                                   const RunContext& run = {});

}  // namespace cloud2csg
