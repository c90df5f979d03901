#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/fields/lipschitz.hpp"
#include "shape/compare/column_grid.hpp"

namespace cloud2csg {
/// A piece of a column between two samples of the field.
struct ModelColumns::Piece {
  std::size_t column;
  double from, to;
  double value_from, value_to;
  bool tried_line = false;  ///< a remainder after linear interpolation

  [[nodiscard]] bool is_cut() const { return (value_from < 0.0) != (value_to < 0.0); }
  [[nodiscard]] double length() const { return to - from; }
};

struct ModelColumns::Cut {
  std::size_t column;
  double depth;

  friend bool operator<(const Cut& a, const Cut& b) {
    return a.column < b.column || (a.column == b.column && a.depth < b.depth);
  }
};

namespace {

/// Shorter pieces are not searched for two cuts that hide between equal signs.
constexpr double k_smallest_gap_spacings = 1.0 / 8.0;
/// Length of the last piece around a cut, relative to the depth. Linear interpolation gives the rest.
constexpr double k_relative_accuracy = 1e-6;

template <typename Piece>
double depth_of_zero(const Piece& piece) {
  const double share = piece.value_from / (piece.value_from - piece.value_to);
  return piece.from + (std::isfinite(share) ? share : 0.5) * piece.length();
}

}  // namespace

ModelColumns::ModelColumns(const Model& model, const ColumnGrid& grid)
    : tree_(tree_of(model)),
      primitives_(model.primitives),
      grid_(grid),
      steepest_(lipschitz_estimate(tree_, primitives_)),
      smallest_gap_(k_smallest_gap_spacings * grid.spacing()) {}

std::vector<double> ModelColumns::values_at(const Points& places) const {
  std::vector<double> values = implicit_value(tree_, primitives_, places);
  // Where an expression is undefined, as the root of a negative number, there is no solid.
  for (double& value : values) {
    if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
  }
  return values;
}

ColumnCuts ModelColumns::cuts(std::size_t first, std::size_t count) const {
  std::vector<Cut> found;
  for (std::vector<Piece> pieces = first_pieces(first, count); !pieces.empty();) pieces = refine(pieces, found);
  std::sort(found.begin(), found.end());
  ColumnCuts cuts;
  std::size_t next = 0;
  for (std::size_t column = first; column < first + count; ++column) {
    for (; next < found.size() && found[next].column == column; ++next) cuts.depths.push_back(found[next].depth);
    cuts.first.push_back(cuts.depths.size());
  }
  return cuts;
}

bool ModelColumns::may_have_cuts(const Piece& piece) const {
  // Two cuts may hide between equal signs if the slope allows the field to reach zero and return.
  return piece.is_cut() || (piece.length() > smallest_gap_ &&
                            std::abs(piece.value_from) + std::abs(piece.value_to) < steepest_ * piece.length());
}

std::vector<ModelColumns::Piece> ModelColumns::first_pieces(std::size_t first, std::size_t count) const {
  constexpr double k_sample_spacings = 4.0;
  const double depth = grid_.high() - grid_.low();
  const auto samples = static_cast<std::size_t>(std::ceil(depth / (k_sample_spacings * grid_.spacing()))) + 1;
  const double step = depth / static_cast<double>(samples - 1);
  const auto sample_depth = [&](std::size_t i) { return grid_.low() + static_cast<double>(i) * step; };
  Points places;
  places.reserve(count * samples);
  for (std::size_t column = first; column < first + count; ++column) {
    for (std::size_t i = 0; i < samples; ++i) places.push_back(grid_.point(column, sample_depth(i)));
  }
  const std::vector<double> values = values_at(places);
  std::vector<Piece> pieces;
  for (std::size_t c = 0; c < count; ++c) {
    const double* const value = values.data() + c * samples;
    for (std::size_t i = 0; i + 1 < samples; ++i) {
      const Piece piece{first + c, sample_depth(i), sample_depth(i + 1), value[i], value[i + 1]};
      if (may_have_cuts(piece)) pieces.push_back(piece);
    }
  }
  return pieces;
}

std::vector<ModelColumns::Piece> ModelColumns::refine(const std::vector<Piece>& pieces, std::vector<Cut>& found) const {
  // Splits a piece in three: equally, or if short closely around its linear zero, which usually ends the search.
  const double close_enough = k_relative_accuracy * (grid_.high() - grid_.low());
  const auto split_of = [&](const Piece& piece) -> std::pair<double, double> {
    if (piece.tried_line || !piece.is_cut() || piece.length() > smallest_gap_) {
      return {piece.from + piece.length() / 3.0, piece.to - piece.length() / 3.0};
    }
    const double zero = depth_of_zero(piece);
    return {std::max(piece.from, zero - 0.4 * close_enough), std::min(piece.to, zero + 0.4 * close_enough)};
  };
  Points places;
  places.reserve(2 * pieces.size());
  for (const Piece& piece : pieces) {
    const auto [low, high] = split_of(piece);
    places.push_back(grid_.point(piece.column, low));
    places.push_back(grid_.point(piece.column, high));
  }
  const std::vector<double> values = values_at(places);
  std::vector<Piece> rest;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    const auto [low, high] = split_of(piece);
    const double value_low = values[2 * i];
    const double value_high = values[2 * i + 1];
    const bool tried_line = !piece.tried_line && piece.is_cut() && piece.length() <= smallest_gap_;
    for (const Piece& part : {Piece{piece.column, piece.from, low, piece.value_from, value_low, tried_line},
                              Piece{piece.column, low, high, value_low, value_high, tried_line},
                              Piece{piece.column, high, piece.to, value_high, piece.value_to, tried_line}}) {
      if (part.is_cut() && part.length() < close_enough) {
        found.push_back({part.column, depth_of_zero(part)});
      } else if (may_have_cuts(part)) {
        rest.push_back(part);
      }
    }
  }
  return rest;
}

}  // namespace cloud2csg
