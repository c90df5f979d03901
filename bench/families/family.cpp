#include "bench/families/family.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <vector>

#include "bench/families/family_parts.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_families{Family::chain,  Family::grid, Family::plate,
                                Family::random, Family::nest, Family::panel};
}  // namespace

std::span<const Family> all_families() {
  return k_families;
}

Family family_of(std::string_view name) {
  if (const std::optional<Family> family = enum_named<Family>(name)) return *family;
  std::vector<Family> all(k_families.begin(), k_families.end());
  throw invalid_option("family", fmt::format("expected one of {}, found '{}'", value_text(all), name));
}

std::optional<OptionConflict> conflict_in(const FamilyOptions& options) {
  if (options.least_clique_size <= options.clique_size) return std::nullopt;
  return OptionConflict{"least_clique_size", fmt::format("expected no more than `clique_size`, {}, found {}",
                                                         options.clique_size, options.least_clique_size)};
}

Model make_family(Family family, const FamilyOptions& options) {
  validate(options);
  FamilyBuilder builder;
  switch (family) {
    case Family::chain:
      build_chain(builder, options);
      break;
    case Family::grid:
      build_grid(builder, options);
      break;
    case Family::plate:
      build_plates(builder, options);
      break;
    case Family::panel:
      build_panel(builder, options);
      break;
    case Family::random:
      build_clusters(builder, options);
      break;
    case Family::nest:
      build_nests(builder, options);
      break;
  }
  return builder.finish(
      fmt::format("Family {}, {} primitives, seed {}", to_string(family), options.primitives, options.seed));
}

}  // namespace cloud2csg
