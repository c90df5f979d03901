#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/extract.hpp"

/// The whole way: a raw cloud in, solids and one tree out.
namespace cloud2csg {

/// Its fields: see the table.
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

/// The options with one seed for all that is random in them.
[[nodiscard]] ReconstructOptions with_seed(ReconstructOptions options, std::uint64_t seed);

/// Cleans and orients the cloud, detects its surfaces and chooses solids that these bound, with the tree that they were
/// chosen with: prepare_cloud(), detect_surfaces(), choose_solids(). Points that lie on known primitives are not
/// offered to the detection; known primitives that the points do not bear out are in no tree, and a warning names them.
/// The same seed gives the same for any number of threads.
/// @throws Error when the cloud has too few points, no surface was found in it, it has no inside, or a known primitive
/// is invalid or has the id of another, or the time limit of the extraction is over before surfaces were found; then
/// on, there are solids to give at any time, with a warning. Cancelled.
[[nodiscard]] Extraction find_primitives(const PointCloud& cloud, const ReconstructOptions& options = {},
                                         const RunContext& run = {});

/// find_primitives(), then extract_csg() over them. The tree is that of the extraction, or the one that the solids were
/// chosen with, whichever costs less in disagreement with the cloud and leaves; or else the refined one.
/// @throws as find_primitives() and extract_csg()
[[nodiscard]] Extraction reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {},
                                     const RunContext& run = {});

}  // namespace cloud2csg
