#include "cloud2csg/reconstruct.hpp"

namespace cloud2csg {

ExtractOptions paper_options() {
  ExtractOptions options;
  options.strategy = Strategy::partition;
  options.objective.beta = 100.0;
  options.precision = Precision::full;
  options.search = paper_ga_options();
  options.without_strangers = false;
  options.polish = false;
  return options;
}

RefineOptions refine_options_for(const ExtractOptions& extraction) {
  return {.angle_tolerance_deg = extraction.segmentation.angle_tolerance_deg};
}

ReconstructOptions with_seed(ReconstructOptions options, std::uint64_t seed) {
  options.extraction.seed = options.detection.seed = options.solids.places.seed = seed;
  return options;
}

}  // namespace cloud2csg
