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
constexpr std::size_t k_most_primitives = 1'000'000;
constexpr std::size_t k_least_clique = 2;
constexpr std::size_t k_most_clique = 20;
constexpr std::size_t k_most_levels = 8;

void require_within(const char* field, std::size_t value, std::size_t least, std::size_t most) {
  if (value >= least && value <= most) return;
  throw Error({.file = {},
               .where = field,
               .expected = fmt::format("expected {} to {}, found {}", least, most, value),
               .remedy = {}});
}

}  // namespace

std::span<const Family> all_families() {
  return k_families;
}

std::string_view to_string(Family family) {
  switch (family) {
    case Family::chain:
      return "chain";
    case Family::grid:
      return "grid";
    case Family::plate:
      return "plate";
    case Family::panel:
      return "panel";
    case Family::random:
      return "random";
    case Family::nest:
      return "nest";
  }
  return "";
}

Family family_of(std::string_view name) {
  const auto* const found = std::ranges::find(k_families, name, [](Family family) { return to_string(family); });
  if (found != k_families.end()) return *found;
  std::vector<std::string_view> names;
  names.reserve(k_families.size());
  for (const Family family : k_families) names.push_back(to_string(family));
  throw Error({.file = {},
               .where = "family",
               .expected = fmt::format("expected one of {}, found '{}'", fmt::join(names, ", "), name),
               .remedy = {}});
}

void validate(const FamilyOptions& options) {
  require_within("primitives", options.primitives, 1, k_most_primitives);
  require_within("clique_size", options.clique_size, k_least_clique, k_most_clique);
  if (options.least_clique_size != 0) {
    require_within("least_clique_size", options.least_clique_size, k_least_clique, options.clique_size);
  }
  require_within("levels", options.levels, 1, k_most_levels);
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
