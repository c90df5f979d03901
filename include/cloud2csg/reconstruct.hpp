#pragma once

#include <string>
#include <vector>

#include "cloud2csg/detect.hpp"
#include "cloud2csg/extract.hpp"
#include "cloud2csg/prepare.hpp"
#include "cloud2csg/solids.hpp"

/// The whole way: a raw cloud in, solids and one tree out.
namespace cloud2csg {

struct ReconstructOptions {
  PrepareOptions preparation = {};
  DetectOptions detection = {};
  /// Close a side that is missing as a whole, as that on which the part stood, by a plane: else nothing tells how far
  /// the solid reaches there.
  bool close_unseen_side = true;
  SolidOptions solids = {};
  ExtractOptions extraction = {};
};

struct FoundPrimitives {
  PreparedCloud prepared;        ///< the cloud that everything else speaks of
  Detection detection;           ///< the surfaces that it lies on
  std::size_t added_points = 0;  ///< on a side that was not seen: the last ones of the cloud
  SolidChoice choice;            ///< a few solids that these bound, and a tree over them
  double prepare_seconds = 0, detect_seconds = 0, choose_seconds = 0;
  std::vector<std::string> warnings;  ///< sentences for the user: what is doubtful, and where
};

/// Cleans and orients the cloud, detects its surfaces and chooses solids that these bound: prepare_cloud(),
/// detect_surfaces(), choose_solids(). The same seed gives the same for any number of threads.
/// @throws Error when the cloud has too few points, no surface was found in it, or it has no inside; Cancelled.
[[nodiscard]] FoundPrimitives find_primitives(const PointCloud& cloud, const ReconstructOptions& options = {},
                                              const RunContext& run = {});

struct Reconstruction {
  PointCloud cloud;     ///< the points that were used, with normals
  PrimitiveSet solids;  ///< as chosen
  CsgTree tree;         ///< over them
  ExtractStatistics statistics;
  std::vector<Snap> snaps = {};  ///< what was made regular
};

/// find_primitives(), then extract_csg() over them. The tree is that of the extraction, or the one that the solids were
/// chosen with, whichever costs less in disagreement with the cloud and leaves.
/// @throws as find_primitives() and extract_csg()
[[nodiscard]] Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options = {},
                                         const RunContext& run = {});

}  // namespace cloud2csg
