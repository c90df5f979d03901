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
        "Primitives that are known: they are kept as they are, of any type, with their ids, and only what the points "
        "show beyond them is detected. Ids are all different.",
        k_library);
  field(&O::preparation, "preparation", "How the cloud is cleaned and oriented");
  field(&O::detection, "detection", "How surfaces are detected");
  field(&O::close_unseen, "close_unseen",
        "Close a side that is missing as a whole, as that on which the part stood, by a plane, and go on with the "
        "walls of bores where no sensor could see them. Else nothing tells how far the solid reaches there. Not where "
        "primitives are known.",
        {.opposite = "leave-open",
         .otherwise = "Do not close a side without any points, as that on which a scanned part stood, by a plane, nor "
                      "go on with walls of bores that no sensor saw"});
  field(&O::solids, "solids", "How solids are chosen");
  field(&O::extraction, "extraction", "How a tree over them is extracted", k_library);
  field(&O::refine, "refine",
        "Then move and size the solids to where the points are, and take them where E is higher so. As in "
        "extract_refined_csg(). Not where primitives are known: these stay.",
        {.absent = "they stay where they are", .option = k_no_option});
}

[[nodiscard]] ReconstructOptions with_seed(ReconstructOptions options, std::uint64_t seed);

/// Cleans and orients the cloud, detects its surfaces, and chooses solids bounded by them with a tree: prepare_cloud(),
/// detect_surfaces(), choose_solids(). Detection skips points on known primitives. The tree leaves out known primitives
/// that the points do not support, and a warning names them. The same seed gives the same result for any number of
/// threads. A time limit that ends after the detection of surfaces gives the best solids so far, with a warning.
/// @throws Error when the cloud has too few points, no surface or no inside was found, a known primitive is invalid or
/// has the id of another, or the extraction's time limit ends before surfaces were found; Cancelled.
[[nodiscard]] Extraction find_primitives(const PointCloud& cloud, const ReconstructOptions& options = {},
                                         const RunContext& run = {});

/// find_primitives(), then extract_csg(). Returns the extracted tree or the tree of the solid choice, whichever has the
/// lower cost (disagreement with the cloud plus leaves); with refinement, the refined tree where it is taken.
/// @throws as find_primitives() and extract_csg()
[[nodiscard]] Extraction reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {},
                                     const RunContext& run = {});

}  // namespace cloud2csg
