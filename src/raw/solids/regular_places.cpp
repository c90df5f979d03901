#include "raw/solids/regular_places.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Index = std::uint32_t;
using GridPlace = std::pair<int, int>;  ///< steps in both directions

constexpr std::size_t k_fewest = 3;  ///< in a row or on a circle
constexpr std::size_t k_most_places = 1000;
constexpr std::size_t k_neighbours = 6;  ///< neighbours to which steps are taken
constexpr std::size_t k_most_steps = 8;  ///< distinct steps to try, the most common first

/// Some of the places, with their exact targets.
struct Found {
  Arrangement arrangement = Arrangement::none;
  std::vector<Index> members = {};
  std::vector<Vector2d> targets = {};
  bool is_about_axis = false;  ///< a circle centred on one of the given centres
  double length = 0;           ///< length of the steps; among grids with equally many members, shorter steps win
};

/// Preference among arrangements with equally many members.
int rank(const Found& found) {
  if (found.arrangement == Arrangement::grid) return 1;
  return found.is_about_axis ? 2 : 0;
}

bool is_better(const Found& a, const Found& b) {
  if (a.members.size() != b.members.size()) return a.members.size() > b.members.size();
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  constexpr double k_shorter = 0.99;  // by more than noise
  return a.length < b.length * k_shorter;
}

/// Members of a grid, with their steps from its origin.
struct GridMembers {
  std::vector<Index> members = {};
  std::vector<GridPlace> at = {};

  [[nodiscard]] bool is_row() const {
    return std::ranges::all_of(at, [this](const GridPlace& place) { return place.second == at[0].second; });
  }

  /// Any three places fit two steps, so a row needs three, a grid two beside its longest row in either direction.
  [[nodiscard]] bool is_meant() const {
    if (is_row()) return members.size() >= k_fewest;
    std::map<int, std::size_t> in_row, in_column;
    for (const auto& [i, j] : at) {
      ++in_row[j];
      ++in_column[i];
    }
    const auto longest = [](const std::map<int, std::size_t>& counts) {
      return std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->second;
    };
    return members.size() >= 2 + std::max(longest(in_row), longest(in_column));
  }
};

class Arranger {
 public:
  Arranger(std::span<const Vector2d> places, std::span<const double> weights, std::span<const Vector2d> centres,
           double tolerance, std::vector<Index> free)
      : places_(places), weights_(weights), centres_(centres), tolerance_(tolerance), free_(std::move(free)) {}

  /// Removes the members of the best arrangement from the free places.
  std::optional<Found> take_best() {
    std::ranges::sort(free_, {}, [this](Index i) { return std::pair(places_[i].x(), i); });
    Found best;
    if (free_.size() >= k_fewest) {
      find_circles(best);
      find_grids(best);
    }
    if (best.members.empty()) return {};
    std::erase_if(free_, [&best](Index i) { return std::ranges::find(best.members, i) != best.members.end(); });
    return best;
  }

 private:
  /// Keeps the first way to arrange the same places that moves none far, if it beats the best.
  void keep(Found& best, std::vector<Found> ways) const {
    const auto found = std::ranges::find_if(ways, [this](const Found& way) { return is_near(way); });
    if (found == ways.end()) return;
    if (best.members.empty() || is_better(*found, best)) best = std::move(*found);
  }

  [[nodiscard]] bool is_near(const Found& found) const {
    for (std::size_t k = 0; k < found.members.size(); ++k) {
      if ((found.targets[k] - places_[found.members[k]]).norm() > tolerance_) return false;
    }
    return true;
  }

  /// The place nearest to the end of a step. Both ends may be inexact.
  [[nodiscard]] std::optional<Index> nearest(const Vector2d& wanted) const {
    const auto x_of = [this](Index i) { return places_[i].x(); };
    std::optional<Index> result;
    double least = 2 * tolerance_;
    for (auto it = std::ranges::lower_bound(free_, wanted.x() - least, {}, x_of);
         it != free_.end() && x_of(*it) <= wanted.x() + 2 * tolerance_; ++it) {
      const double distance = (places_[*it] - wanted).norm();
      if (distance > least) continue;
      least = distance;
      result = *it;
    }
    return result;
  }

  /// Differences between neighbours, the most common first. None is the opposite of another.
  [[nodiscard]] std::vector<Vector2d> common_steps() const {
    std::vector<std::pair<Vector2d, std::size_t>> steps;
    for (const Index from : free_) {
      std::vector<Vector2d> around;
      for (const Index to : free_) {
        if (to != from) around.emplace_back(places_[to] - places_[from]);
      }
      const std::size_t near = std::min(k_neighbours, around.size());
      std::ranges::partial_sort(around, around.begin() + static_cast<std::ptrdiff_t>(near), {},
                                [](const Vector2d& step) { return step.squaredNorm(); });
      for (std::size_t k = 0; k < near; ++k) count(around[k], steps);
    }
    std::erase_if(steps, [this](const auto& step) { return step.first.norm() <= 4 * tolerance_; });
    std::ranges::stable_sort(steps, [](const auto& a, const auto& b) {
      if (a.second != b.second) return a.second > b.second;
      return a.first.squaredNorm() < b.first.squaredNorm();
    });
    std::vector<Vector2d> result;
    for (std::size_t k = 0; k < std::min(k_most_steps, steps.size()); ++k) result.push_back(steps[k].first);
    return result;
  }

  void count(Vector2d step, std::vector<std::pair<Vector2d, std::size_t>>& steps) const {
    if (step.x() < -2 * tolerance_ || (step.x() <= 2 * tolerance_ && step.y() < 0)) step = -step;
    const auto same =
        std::ranges::find_if(steps, [&](const auto& one) { return (one.first - step).norm() <= 2 * tolerance_; });
    if (same == steps.end()) {
      steps.emplace_back(step, 1);
    } else {
      ++same->second;
      same->first += (step - same->first) / static_cast<double>(same->second);
    }
  }

  void find_grids(Found& best) const {
    const std::vector<Vector2d> steps = common_steps();
    for (std::size_t a = 0; a < steps.size(); ++a) {
      find_grids(steps[a], Vector2d::Zero(), best);
      for (std::size_t b = a + 1; b < steps.size(); ++b) {
        const double cross = steps[a].x() * steps[b].y() - steps[a].y() * steps[b].x();
        if (std::abs(cross) > 0.1 * steps[a].norm() * steps[b].norm()) find_grids(steps[a], steps[b], best);
      }
    }
  }

  /// Grids of places connected by these steps. A zero second step means rows.
  void find_grids(const Vector2d& first, const Vector2d& second, Found& best) const {
    std::vector<bool> is_seen(places_.size(), false);
    for (const Index start : free_) {
      if (is_seen[start]) continue;
      const GridMembers grid = reached(start, first, second, is_seen);
      const bool is_row = grid.is_row();
      if (!grid.is_meant()) continue;
      if (is_row && second != Vector2d::Zero()) continue;  // found with the first step alone
      const double along = std::atan2(first.y(), first.x());
      const double turn = std::round(along / (0.5 * std::numbers::pi)) * 0.5 * std::numbers::pi;
      std::vector<Found> ways;  // the simplest first
      for (const double angle : {turn, along}) {
        if (!is_row) ways.push_back(upright(grid, angle, true));
        ways.push_back(upright(grid, angle, false));
      }
      ways.push_back(skew(grid));
      keep(best, std::move(ways));
    }
  }

  [[nodiscard]] GridMembers reached(Index start, const Vector2d& first, const Vector2d& second,
                                    std::vector<bool>& is_seen) const {
    GridMembers grid{.members = {start}, .at = {{0, 0}}};
    is_seen[start] = true;
    std::vector<std::pair<Vector2d, GridPlace>> steps{{first, {1, 0}}, {-first, {-1, 0}}};
    if (second != Vector2d::Zero()) steps.insert(steps.end(), {{second, {0, 1}}, {-second, {0, -1}}});
    for (std::size_t k = 0; k < grid.members.size(); ++k) {
      for (const auto& [step, by] : steps) {
        const std::optional<Index> next = nearest(places_[grid.members[k]] + step);
        if (!next || is_seen[*next]) continue;
        is_seen[*next] = true;
        grid.members.push_back(*next);
        grid.at.emplace_back(grid.at[k].first + by.first, grid.at[k].second + by.second);
      }
    }
    return grid;
  }

  /// Least squares of origin and orthogonal steps, the first at `angle` to the first axis.
  [[nodiscard]] Found upright(const GridMembers& grid, double angle, bool are_equal) const {
    const Eigen::Rotation2Dd turn(angle);
    const auto n = static_cast<Eigen::Index>(grid.members.size());
    const bool is_row = grid.is_row();
    // Origin, then one step or two.
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, is_row || are_equal ? 3 : 4);
    Eigen::VectorXd b(2 * n);
    const Vector2d origin = places_[grid.members[0]];
    // The second step may be on either side.
    const double side = second_side(grid, turn);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto [i, j] = grid.at[static_cast<std::size_t>(k)];
      const Index member = grid.members[static_cast<std::size_t>(k)];
      const double weight = std::sqrt(weights_[member]);
      const Vector2d local = weight * (turn.inverse() * (places_[member] - origin));
      a(2 * k, 0) = a(2 * k + 1, 1) = weight;
      a(2 * k, 2) = weight * i;
      if (!is_row) a(2 * k + 1, are_equal ? 2 : 3) = weight * side * j;
      b.segment<2>(2 * k) = local;
    }
    const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
    Found found = grid_found(grid, std::abs(x[2]) + (is_row ? 0 : std::abs(x[are_equal ? 2 : 3])));
    for (const auto& [i, j] : grid.at) {
      const double v = is_row ? 0 : x[are_equal ? 2 : 3] * side * j;
      found.targets.emplace_back(origin + turn * Vector2d(x[0] + x[2] * i, x[1] + v));
    }
    return found;
  }

  [[nodiscard]] double second_side(const GridMembers& grid, const Eigen::Rotation2Dd& turn) const {
    double sum = 0;
    for (std::size_t k = 0; k < grid.members.size(); ++k) {
      const Vector2d local = turn.inverse() * (places_[grid.members[k]] - places_[grid.members[0]]);
      sum += grid.at[k].second * local.y();
    }
    return sum < 0 ? -1 : 1;
  }

  /// Least squares of origin and arbitrary steps.
  [[nodiscard]] Found skew(const GridMembers& grid) const {
    const auto n = static_cast<Eigen::Index>(grid.members.size());
    const bool is_row = grid.is_row();
    Eigen::MatrixXd a(n, is_row ? 2 : 3);
    Eigen::MatrixXd b(n, 2);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto [i, j] = grid.at[static_cast<std::size_t>(k)];
      const Index member = grid.members[static_cast<std::size_t>(k)];
      const double weight = std::sqrt(weights_[member]);
      a(k, 0) = weight;
      a(k, 1) = weight * i;
      if (!is_row) a(k, 2) = weight * j;
      b.row(k) = weight * places_[member].transpose();
    }
    const Eigen::MatrixXd x = a.colPivHouseholderQr().solve(b);
    Found found = grid_found(grid, x.bottomRows(x.rows() - 1).rowwise().norm().sum());
    for (const auto& [i, j] : grid.at) {
      Vector2d target = x.row(0) + i * x.row(1);
      if (!is_row) target += j * x.row(2).transpose();
      found.targets.push_back(target);
    }
    return found;
  }

  static Found grid_found(const GridMembers& grid, double length) {
    return {.arrangement = Arrangement::grid, .members = grid.members, .targets = {}, .length = length};
  }

  void find_circles(Found& best) const {
    for (const Vector2d& centre : centres_) {
      std::vector<std::pair<double, Index>> by_distance;
      for (const Index i : free_) by_distance.emplace_back((places_[i] - centre).norm(), i);
      std::ranges::sort(by_distance);
      for (std::size_t begin = 0, end = 0; begin < by_distance.size(); begin = end) {
        std::vector<Index> ring;
        for (; end < by_distance.size() && by_distance[end].first <= by_distance[begin].first + 2 * tolerance_; ++end) {
          ring.push_back(by_distance[end].second);
        }
        std::vector<Found> ways = circles(std::move(ring), centre);
        for (Found& way : ways) way.is_about_axis = true;
        keep(best, std::move(ways));
      }
    }
    if (const std::optional<Vector2d> centre = centre_of_all()) keep(best, circles(free_, *centre));
  }

  /// Linear least squares of |p|^2 = 2 c p + (r^2 - c^2).
  [[nodiscard]] std::optional<Vector2d> centre_of_all() const {
    const auto n = static_cast<Eigen::Index>(free_.size());
    Eigen::MatrixXd a(n, 3);
    Eigen::VectorXd b(n);
    const Vector2d origin = places_[free_[0]];
    for (Eigen::Index k = 0; k < n; ++k) {
      const Vector2d p = places_[free_[static_cast<std::size_t>(k)]] - origin;
      a.row(k) << 2 * p.x(), 2 * p.y(), 1;
      b[k] = p.squaredNorm();
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(a);
    if (solver.rank() < 3) return {};
    const Eigen::Vector3d x = solver.solve(b);
    return origin + x.head<2>();
  }

  /// Full circles at equal angles: symmetric to an axis of the plane, or from any angle.
  [[nodiscard]] std::vector<Found> circles(std::vector<Index> ring, const Vector2d& centre) const {
    if (ring.size() < k_fewest) return {};
    const auto angle_of = [&](Index i) {
      const Vector2d arm = places_[i] - centre;
      return std::atan2(arm.y(), arm.x());
    };
    std::ranges::sort(ring, {}, [&](Index i) { return std::pair(angle_of(i), i); });
    const double step = 2 * std::numbers::pi / static_cast<double>(ring.size());
    double weights = 0, radius = 0, cosine = 0, sine = 0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const double weight = weights_[ring[k]];
      const double off = angle_of(ring[k]) - static_cast<double>(k) * step;
      weights += weight;
      radius += weight * (places_[ring[k]] - centre).norm();
      cosine += weight * std::cos(off);
      sine += weight * std::sin(off);
    }
    radius /= weights;
    const double start = std::atan2(sine, cosine);
    if (radius * std::sin(0.5 * std::min(step, std::numbers::pi)) <= 2 * tolerance_) return {};
    const double part = ring.size() % 2 == 0 ? 0.5 * step : 0.25 * step;
    return {on_circle(ring, centre, radius, std::round(start / part) * part), on_circle(ring, centre, radius, start)};
  }

  [[nodiscard]] static Found on_circle(const std::vector<Index>& ring, const Vector2d& centre, double radius,
                                       double start) {
    Found found{.arrangement = Arrangement::circle, .members = ring};
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const double angle = start + 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(ring.size());
      found.targets.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
    }
    return found;
  }

  std::span<const Vector2d> places_;
  std::span<const double> weights_;
  std::span<const Vector2d> centres_;
  double tolerance_;
  std::vector<Index> free_;  ///< sorted by the first coordinate
};

}  // namespace

RegularPlaces regular_places(std::span<const Vector2d> places, std::span<const int> kinds,
                             std::span<const double> weights, std::span<const Vector2d> centres, double tolerance) {
  RegularPlaces result{.places = {places.begin(), places.end()},
                       .arrangements = std::vector<Arrangement>(places.size(), Arrangement::none)};
  std::map<int, std::vector<Index>> of_kind;
  for (Index i = 0; i < places.size(); ++i) of_kind[kinds[i]].push_back(i);
  for (auto& [kind, members] : of_kind) {
    if (members.size() > k_most_places) continue;
    Arranger arranger(places, weights, centres, tolerance, std::move(members));
    while (const std::optional<Found> found = arranger.take_best()) {
      for (std::size_t k = 0; k < found->members.size(); ++k) {
        result.places[found->members[k]] = found->targets[k];
        result.arrangements[found->members[k]] = found->arrangement;
      }
    }
  }
  return result;
}

}  // namespace cloud2csg
