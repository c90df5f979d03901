#include "io/scripts/patterns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "core/primitive/shape.hpp"

namespace cloud2csg::script {
namespace {

constexpr double k_infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t k_fewest = 3;
constexpr std::size_t k_most_in_line = 256;
constexpr std::size_t k_most_in_circle = 48;
constexpr std::size_t k_most_in_small_grid = 16;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

Pose motion_of(const LinePattern& line, std::size_t place) {
  return {.position = static_cast<double>(place) * line.step};
}

Pose motion_of(const GridPattern& grid, std::size_t place) {
  const std::size_t row = place / grid.columns;
  const std::size_t column = place % grid.columns;
  return {.position = static_cast<double>(column) * grid.step + static_cast<double>(row) * grid.row_step};
}

Pose motion_of(const CirclePattern& circle, std::size_t place) {
  const double angle = radians(static_cast<double>(place) * circle.angle_deg);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, circle.axis));
  return {.position = circle.centre - turn * circle.centre, .orientation = turn};
}

/// More members, or as many at smaller angles, so that the pattern goes round only once.
bool is_better_circle(const Pattern& a, const Pattern& b) {
  if (a.members.size() != b.members.size()) return a.members.size() > b.members.size();
  const auto angle = [](const Pattern& pattern) { return std::get<CirclePattern>(pattern.motion).angle_deg; };
  return angle(a) < angle(b) - 1e-6;
}

using Motion = decltype(Pattern::motion);

/// The part at a place of the pattern that begins with `first`.
Part placed(const Part& first, const Motion& motion, std::size_t place) {
  return std::visit(
      Overloaded{[&](const MirrorPattern& mirror) { return place == 0 ? first : mirrored(first, mirror.plane); },
                 [&](const auto& way) { return moved(first, motion_of(way, place)); }},
      motion);
}

bool is_backward(const Eigen::Vector3d& step) {
  Eigen::Index largest = 0;
  step.cwiseAbs().maxCoeff(&largest);
  return step[largest] < 0;
}

/// Reorders the members so that the largest coordinate of each step is positive.
void turn_forward(Pattern& pattern) {
  const auto begin = pattern.members.begin();
  if (auto* line = std::get_if<LinePattern>(&pattern.motion); line && is_backward(line->step)) {
    std::reverse(begin, pattern.members.end());
    line->step = -line->step;
  }
  auto* grid = std::get_if<GridPattern>(&pattern.motion);
  if (!grid) return;
  const auto columns = static_cast<std::ptrdiff_t>(grid->columns);
  const auto reverse_rows = [&] {
    for (auto row = begin; row != pattern.members.end(); row += columns) std::reverse(row, row + columns);
  };
  if (is_backward(grid->step)) {
    reverse_rows();
    grid->step = -grid->step;
  }
  if (is_backward(grid->row_step)) {
    std::reverse(begin, pattern.members.end());
    reverse_rows();
    grid->row_step = -grid->row_step;
  }
}

bool is_along_axes(const GridPattern& grid, double tolerance) {
  const auto is_along = [tolerance](const Eigen::Vector3d& step) {
    return step.norm() - step.cwiseAbs().maxCoeff() <= tolerance;
  };
  return is_along(grid.step) && is_along(grid.row_step);
}

class Group {
 public:
  Group(std::span<const Part> parts, double tolerance) : parts_(parts), tolerance_(tolerance) {}

  void add(std::size_t index) {
    free_.push_back(index);
    centres_.emplace(index, centre_of(at(index)));
  }
  [[nodiscard]] bool takes(std::size_t index) const { return are_alike(at(free_.front()), at(index), tolerance_); }

  std::optional<Pattern> take_longest() {
    Pattern longest;
    const auto keep_longer = [&longest](std::optional<Pattern> pattern) {
      if (pattern && pattern->members.size() > longest.members.size()) longest = std::move(*pattern);
    };
    if (free_.size() <= k_most_in_line) keep_longer(widest_grid(longest_line()));
    if (free_.size() <= k_most_in_circle) keep_longer(longest_circle());
    if (longest.members.size() <= 4 && free_.size() <= k_most_in_small_grid) {
      std::optional<Pattern> grid = grid_of_pairs();
      const bool is_square = grid && grid->members.size() == longest.members.size() &&
                             std::holds_alternative<CirclePattern>(longest.motion) &&
                             is_along_axes(std::get<GridPattern>(grid->motion), tolerance_);
      if (is_square)
        longest = std::move(*grid);
      else
        keep_longer(std::move(grid));
    }
    if (longest.members.size() < k_fewest) return take_pair();
    return taken(std::move(longest));
  }

 private:
  [[nodiscard]] const Part& at(std::size_t index) const { return parts_[index]; }
  [[nodiscard]] const Eigen::Vector3d& position(std::size_t index) const { return centres_.at(index); }

  Pattern taken(Pattern pattern) {
    pattern.deviation = deviation(pattern);
    Pattern turned = pattern;
    turn_forward(turned);
    turned.deviation = deviation(turned);
    if (turned.deviation <= tolerance_) pattern = std::move(turned);
    std::erase_if(free_, [&pattern](std::size_t index) {
      return std::find(pattern.members.begin(), pattern.members.end(), index) != pattern.members.end();
    });
    return pattern;
  }

  /// Two parts of several solids. For single solids a loop would be no shorter.
  std::optional<Pattern> take_pair() {
    if (free_.size() < 2 || free_.size() > k_most_in_circle || at(free_.front()).kind == Part::Kind::solid) return {};
    const auto any_pair = [this](const auto& motion_between) -> std::optional<Pattern> {
      for (std::size_t i = 0; i < free_.size(); ++i) {
        for (std::size_t j = i + 1; j < free_.size(); ++j) {
          const Eigen::Vector3d step = position(free_[j]) - position(free_[i]);
          if (step.norm() <= 2 * tolerance_) continue;
          Pattern pair{.members = {free_[i], free_[j]}, .motion = motion_between(position(free_[i]), step)};
          if (deviation(pair) <= tolerance_) return pair;
        }
      }
      return {};
    };
    std::optional<Pattern> pair = any_pair([](const Eigen::Vector3d& from, const Eigen::Vector3d& step) -> Motion {
      const Eigen::Vector3d normal = step.normalized();
      return MirrorPattern{{.normal = normal, .offset = normal.dot(from + 0.5 * step)}};
    });
    if (!pair) {
      pair = any_pair(
          [](const Eigen::Vector3d& /*from*/, const Eigen::Vector3d& step) -> Motion { return LinePattern{step}; });
    }
    return pair ? std::optional(taken(std::move(*pair))) : std::nullopt;
  }

  [[nodiscard]] std::optional<std::size_t> find(const Part& wanted) const {
    const Eigen::Vector3d centre = centre_of(wanted);
    for (const std::size_t index : free_) {
      if ((position(index) - centre).norm() > tolerance_) continue;
      if (misfit(wanted, at(index), tolerance_) <= tolerance_) return index;
    }
    return {};
  }

  [[nodiscard]] double deviation(const Pattern& pattern) const {
    double most = 0;
    for (std::size_t place = 1; place < pattern.members.size(); ++place) {
      const Part wanted = placed(at(pattern.members[0]), pattern.motion, place);
      most = std::max(most, misfit(wanted, at(pattern.members[place]), tolerance_));
    }
    return most;
  }

  /// All members that repeating the motion reaches from the first.
  [[nodiscard]] Pattern chain(std::size_t first, const Motion& motion) const {
    Pattern pattern{.members = {first}, .motion = motion};
    while (true) {
      const Part wanted = placed(at(first), motion, pattern.members.size());
      const std::optional<std::size_t> next = find(wanted);
      // Back at the first, or at one of two solids in the same place.
      if (!next || std::find(pattern.members.begin(), pattern.members.end(), *next) != pattern.members.end()) break;
      pattern.members.push_back(*next);
    }
    return pattern;
  }

  [[nodiscard]] std::optional<Pattern> longest_line() const {
    std::optional<Pattern> longest;
    double longest_step = 0;
    for (const std::size_t first : free_) {
      for (const std::size_t second : free_) {
        const Eigen::Vector3d step = position(second) - position(first);
        if (step.norm() <= 2 * tolerance_) continue;
        if (find(moved(at(first), {.position = -step}))) continue;
        Pattern line = chain(first, LinePattern{.step = step});
        const std::size_t least = longest ? longest->members.size() : k_fewest;
        if (line.members.size() < least) continue;
        if (longest && line.members.size() == least && !(step.norm() < longest_step * (1 - 1e-9))) continue;
        longest = std::move(line);
        longest_step = step.norm();
      }
    }
    return longest;
  }

  /// The grid of all rows that the row step reaches from the line; absent if the line is not its first row.
  [[nodiscard]] std::optional<Pattern> grid_of(const Pattern& line, const Eigen::Vector3d& row_step) const {
    const LinePattern along = std::get<LinePattern>(line.motion);
    const auto row_from = [&](const Eigen::Vector3d& offset) {
      std::vector<std::size_t> row;
      for (std::size_t place = 0; place < line.members.size(); ++place) {
        const Pose there{.position = offset + static_cast<double>(place) * along.step};
        const std::optional<std::size_t> member = find(moved(at(line.members[0]), there));
        if (!member) return std::vector<std::size_t>{};
        row.push_back(*member);
      }
      return row;
    };
    if (!row_from(-row_step).empty()) return {};  // that row finds the grid
    Pattern grid{.members = line.members, .motion = GridPattern{along.step, row_step, line.members.size()}};
    for (double rows = 1;; ++rows) {
      const std::vector<std::size_t> row = row_from(rows * row_step);
      const auto is_taken = [&grid](std::size_t one) {
        return std::find(grid.members.begin(), grid.members.end(), one) != grid.members.end();
      };
      if (row.empty() || std::any_of(row.begin(), row.end(), is_taken)) break;
      grid.members.insert(grid.members.end(), row.begin(), row.end());
    }
    if (grid.members.size() == line.members.size()) return {};
    return grid;
  }

  /// The grid of most rows like `line`, with the least row step; the line itself if it has one row.
  [[nodiscard]] std::optional<Pattern> widest_grid(const std::optional<Pattern>& line) const {
    if (!line) return {};
    Pattern widest = *line;
    double least_step = k_infinite;
    // Any row of the grid may be the first.
    for (const std::size_t from : free_) {
      Pattern row = chain(from, line->motion);
      if (row.members.size() != line->members.size()) continue;
      for (const std::size_t to : free_) {
        const Eigen::Vector3d step = position(to) - position(from);
        const Eigen::Vector3d along = std::get<LinePattern>(line->motion).step;
        if (to == from || step.cross(along).norm() <= 2 * tolerance_ * along.norm()) continue;
        if (widest.members.size() > line->members.size() && step.norm() > least_step * (1 + 1e-9)) continue;
        const std::optional<Pattern> grid = grid_of(row, step);
        if (!grid || grid->members.size() < widest.members.size()) continue;
        const bool is_wider = grid->members.size() > widest.members.size();
        if (!is_wider && !(step.norm() < least_step * (1 - 1e-9))) continue;
        widest = *grid;
        least_step = step.norm();
      }
    }
    return widest;
  }

  /// The largest grid of at least two rows of two: corners of rectangles.
  [[nodiscard]] std::optional<Pattern> grid_of_pairs() const {
    std::optional<Pattern> widest;
    for (const std::size_t first : free_) {
      for (const std::size_t second : free_) {
        const Eigen::Vector3d step = position(second) - position(first);
        if (step.norm() <= 2 * tolerance_) continue;
        std::optional<Pattern> grid = widest_grid(Pattern{.members = {first, second}, .motion = LinePattern{step}});
        if (grid && grid->members.size() >= 4 && (!widest || grid->members.size() > widest->members.size())) {
          widest = std::move(grid);
        }
      }
    }
    return widest;
  }

  [[nodiscard]] std::optional<Pattern> longest_circle() const {
    std::optional<Pattern> longest;
    for (const std::size_t first : free_) {
      for (const std::size_t second : free_) {
        for (const std::size_t third : free_) {
          std::optional<Pattern> circle = circle_through(first, second, third);
          if (circle && (!longest || is_better_circle(*circle, *longest))) longest = std::move(circle);
        }
      }
    }
    return longest;
  }

  [[nodiscard]] std::optional<Pattern> circle_through(std::size_t first, std::size_t second, std::size_t third) const {
    const Eigen::Vector3d a = position(second) - position(first);
    const Eigen::Vector3d b = position(third) - position(second);
    if (std::abs(a.norm() - b.norm()) > 2 * tolerance_ || a.norm() <= 2 * tolerance_) return {};
    const Eigen::Vector3d normal = a.cross(b);
    if (normal.norm() <= 1e-3 * a.squaredNorm()) return {};  // nearly on a line
    std::optional<CirclePattern> motion = circle_of(a, b, normal.normalized(), position(second));
    if (!motion) return {};
    Pattern circle = chain(first, *motion);
    const auto count = static_cast<double>(circle.members.size());
    const bool divides = std::abs(std::remainder(360.0, motion->angle_deg)) < 1e-9;
    motion->is_full = std::abs(count * motion->angle_deg - 360.0) < 1e-9;
    circle.motion = *motion;
    // Three solids may lie on a circle by accident, unless their angle divides 360 degrees.
    const bool is_meant = divides ? count >= 3 : count >= 4;
    return is_meant ? std::optional(circle) : std::nullopt;
  }

  /// The circle of two consecutive chords of equal length that meet at `corner`.
  [[nodiscard]] std::optional<CirclePattern> circle_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                                       const Eigen::Vector3d& axis,
                                                       const Eigen::Vector3d& corner) const {
    // Each circle has two directions; takes the one about the positive axis.
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) return {};
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    const Eigen::Vector3d inward = (b - a).normalized();
    const double radius = 0.5 * a.norm() / std::sin(0.5 * angle);
    double degrees = angle * 180.0 / std::numbers::pi;
    const double whole = 360.0 / std::round(360.0 / degrees);
    if (std::abs(radians(whole - degrees)) * radius <= tolerance_) degrees = whole;
    return CirclePattern{.centre = corner + radius * inward, .axis = axis, .angle_deg = degrees, .is_full = false};
  }

  std::span<const Part> parts_;
  double tolerance_;
  std::vector<std::size_t> free_ = {};
  std::map<std::size_t, Eigen::Vector3d> centres_ = {};
};

}  // namespace

std::vector<Pattern> find_patterns(std::span<const Part> parts, double tolerance) {
  std::vector<Group> groups;
  for (std::size_t index = 0; index < parts.size(); ++index) {
    const auto group =
        std::find_if(groups.begin(), groups.end(), [index](const Group& one) { return one.takes(index); });
    (group == groups.end() ? groups.emplace_back(parts, tolerance) : *group).add(index);
  }
  std::vector<Pattern> patterns;
  for (Group& group : groups) {
    while (std::optional<Pattern> pattern = group.take_longest()) patterns.push_back(std::move(*pattern));
  }
  std::stable_sort(patterns.begin(), patterns.end(),
                   [](const Pattern& a, const Pattern& b) { return a.members.size() > b.members.size(); });
  return patterns;
}

Part member_of(std::span<const Part> parts, const Pattern& pattern, std::size_t place) {
  return placed(parts[pattern.members.front()], pattern.motion, place);
}

}  // namespace cloud2csg::script
