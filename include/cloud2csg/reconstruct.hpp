#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/extract.hpp"

/// The whole way from a raw cloud to solids and one tree.
namespace cloud2csg {

struct ReconstructOptions {
  PrimitiveSet known = {};
  PrepareOptions preparation = {};
  DetectOptions detection = {};
  bool close_unseen = true;
  SolidOptions solids = {};
  ExtractOptions extraction = {};
  std::optional<RefineOptions> refine = {};
};
void option_table(OptionsOf<ReconstructOptions>, auto&& field) {
  using O = ReconstructOptions;
  field(&O::known, "known",
        "Known primitives of any type, with distinct ids. They are kept unchanged; detection looks only for what the "
        "points show beyond them.",
        k_library);
  field(&O::preparation, "preparation", "Cleaning of the cloud and its normals");
  field(&O::detection, "detection", "Detection of surfaces");
  field(
      &O::close_unseen, "close_unseen",
      "Close a side without any points, such as the one on which a scanned part stood, and undersides of overhangs "
      "by planes, and extend the walls of bores and bent pipes where no sensor could see them. Without this, nothing "
      "tells how far the solid reaches there. Has no effect with known primitives.",
      {.opposite = "leave-open",
       .otherwise = "Do not close a side without any points, such as the one on which a scanned part stood, nor "
                    "undersides of overhangs by planes, nor extend walls of bores and bent pipes that no sensor saw"});
  field(&O::solids, "solids", "Choice of the solids");
  field(&O::extraction, "extraction", "Extraction of a tree over the solids", k_library);
  field(&O::refine, "refine",
        "Then fit positions, directions and sizes of the solids to the points, and keep the result if E is higher. "
        "The tree stays. Refused with known primitives, which stay unchanged.",
        {.absent = "the solids stay as chosen", .option = k_no_option});
}

[[nodiscard]] ReconstructOptions with_seed(ReconstructOptions options, std::uint64_t seed);

/// Cleans and orients the cloud, detects its surfaces, and chooses solids bounded by them with a tree: prepare_cloud(),
/// detect_surfaces(), choose_solids(). Doubted points that are then on no surface are left out as outliers. Detection
/// skips points on known primitives. The tree leaves out known primitives that the points do not support, and a warning
/// names them. The same seed gives the same result for any number of threads. A time limit that ends after the
/// detection of surfaces gives the best solids so far, with a warning.
/// Surfaces that bound no solid come without new solids and a tree.
/// @throws Error when the cloud has too few points, no surface was found, a known primitive is invalid or has the id of
/// another, or the extraction's time limit ends before surfaces were found; Cancelled.
[[nodiscard]] Extraction find_primitives(const PointCloud& cloud, const ReconstructOptions& options = {},
                                         const RunContext& run = {});

/// find_primitives(), measured and judged as extract_csg() does it. The tree is the one that the solids were chosen
/// with; with another strategy than automatic, extract_csg() searches one over them.
/// @throws as find_primitives() and extract_csg(), and Error when the surfaces bound no solid
[[nodiscard]] Extraction reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {},
                                     const RunContext& run = {});

}  // namespace cloud2csg
