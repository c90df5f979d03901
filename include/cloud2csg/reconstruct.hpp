#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/extract.hpp"

/// The whole way: a raw cloud in, solids and one tree out.
namespace cloud2csg {

struct ReconstructOptions {
  /// What somebody knows: these primitives are kept as they are, of any type, with their ids, and only what the points
  /// show beyond them is detected. Ids are all different.
  PrimitiveSet known = {};
  PrepareOptions preparation = {};
  DetectOptions detection = {};
  /// Close a side that is missing as a whole, as that on which the part stood, by a plane, and go on with the walls of
  /// bores where no sensor could see them: else nothing tells how far the solid reaches there. Not where primitives are
  /// known.
  bool close_unseen = true;
  SolidOptions solids = {};
  ExtractOptions extraction = {};
  /// Then move and size the solids to where the points are, as in extract_refined_csg(), and take them and the tree
  /// over them where E is higher so. Not where primitives are known: these stay.
  std::optional<RefineOptions> refine = {};
};

/// Cleans and orients the cloud, detects its surfaces and chooses solids that these bound, with the tree that they were
/// chosen with: prepare_cloud(),
/// detect_surfaces(), choose_solids(). Points that lie on known primitives are not offered to the detection; known
/// primitives that the points do not bear out are in no tree, and a warning names them. The same seed gives the same
/// for any number of threads.
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
