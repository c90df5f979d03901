#include "cloud2csg/extract.hpp"

namespace cloud2csg {
std::string_view to_string(MergeWay way) {
  switch (way) {
    case MergeWay::single:
      return "single";
    case MergeWay::paper:
      return "paper";
    case MergeWay::dominance:
      return "dominance";
    case MergeWay::largest_common_subtree:
      return "largest_common_subtree";
    case MergeWay::joint:
      return "joint";
    case MergeWay::search:
      return "search";
  }
  return "";
}

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

}  // namespace cloud2csg
