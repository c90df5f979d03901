#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"
#include "raw/detect/grow.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Whether a point is evidence for a surface.
using IsEvidence = std::function<bool(std::uint32_t point)>;

/// Surfaces to begin with, and how many are enough.
struct SearchStart {
  std::vector<GrownSurface> found = {};
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

/// Finds one surface after another until several rounds in a row find none, each with twice as many draws. Evidence for
/// a surface are only its points for which `is_evidence(point)` holds; of a surface without enough evidence, the other
/// points count as taken. @throws Cancelled
[[nodiscard]] std::vector<GrownSurface> find_all(FreePoints& points, const SearchLimits& limits, std::uint64_t seed,
                                                 const IsEvidence& is_evidence, const RunContext& run,
                                                 const StageShare& share = {}, SearchStart start = {});

/// Surfaces before they settle, the noise of the largest planes, and limits by it.
struct FirstSurfaces {
  Scale scale;
  SearchLimits limits;
  std::vector<GrownSurface> surfaces;
};

/// Finds surfaces, and again while they show clearly more noise in a part of the cloud than the limits allow for. From
/// then on, the noise is at least a third of the least tolerance: distances count in units of the noise, and so would
/// the form errors that the tolerance allows for. Points beyond the first surfaces get normals of their own. @throws
/// Cancelled
[[nodiscard]] FirstSurfaces find_surfaces(WorkCloud& cloud, const NeighbourTable& neighbours, Scale scale,
                                          const DetectOptions& options, const RunContext& run, const StageShare& share);

}  // namespace cloud2csg
