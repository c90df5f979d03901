#include "paper/segment/supported_primitives.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

/// How many of the primitives left out the warnings name.
constexpr std::size_t k_named_warnings = 10;

}  // namespace

SupportedPrimitives take_all(const PrimitiveSet& primitives) {
  SupportedPrimitives all{.primitives = primitives, .original = std::vector<PrimitiveIndex>(primitives.size())};
  std::iota(all.original.begin(), all.original.end(), PrimitiveIndex{0});
  return all;
}

SupportedPrimitives without_unsupported(SupportedPrimitives supported,
                                        std::span<const std::size_t> points_of_primitive) {
  SupportedPrimitives kept{.primitives = {}, .original = {}, .warnings = std::move(supported.warnings)};
  std::size_t dropped = 0;
  for (std::size_t p = 0; p < points_of_primitive.size(); ++p) {
    if (points_of_primitive[p] > 0) {
      kept.primitives.push_back(std::move(supported.primitives[p]));
      kept.original.push_back(supported.original[p]);
    } else if (dropped++ < k_named_warnings) {
      kept.warnings.push_back(
          fmt::format("no point supports primitive '{}', so it is left out", supported.primitives[p].id));
    }
  }
  if (dropped > k_named_warnings) {
    kept.warnings.push_back(
        fmt::format("no point supports {} more primitives, so they are left out", dropped - k_named_warnings));
  }
  if (kept.primitives.empty()) {
    throw Error({.expected = "no point of the cloud is near any primitive",
                 .remedy = "check that cloud and primitives are in the same frame and units"});
  }
  return kept;
}

}  // namespace cloud2csg
