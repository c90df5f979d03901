#include "export/openscad_loops.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "export/openscad_text.hpp"
#include "primitive/overloaded.hpp"

namespace cloud2csg::openscad {
namespace {

using Kind = script::Step::Kind;

/// As a parameter.
std::string count_of(std::size_t members, Parameters& parameters) {
  return parameters.add("count", fmt::format("{}", members));
}

std::string around(const script::LinePattern& line, std::size_t members, const script::NumberFormat& number,
                   Parameters& parameters) {
  const std::string count = count_of(members, parameters);
  return fmt::format("for (i = [0 : {} - 1]) translate(i * {}) ", count,
                     parameters.add("step", list(line.step, number)));
}

std::string around(const script::GridPattern& grid, std::size_t members, const script::NumberFormat& number,
                   Parameters& parameters) {
  const std::string columns = parameters.add("columns", fmt::format("{}", grid.columns));
  const std::string rows = parameters.add("rows", fmt::format("{}", members / grid.columns));
  const std::string step = parameters.add("step", list(grid.step, number));
  return fmt::format("for (i = [0 : {} - 1], j = [0 : {} - 1]) translate(i * {} + j * {}) ", columns, rows, step,
                     parameters.add("row_step", list(grid.row_step, number)));
}

std::string around(const script::CirclePattern& circle, std::size_t members, const script::NumberFormat& number,
                   Parameters& parameters) {
  const std::string count = count_of(members, parameters);
  const script::NumberFormat plain(1.0);
  // A full circle stays one when the count is changed.
  const std::string angle = circle.is_full ? "360 / " + count : parameters.add("angle", plain(circle.angle_deg));
  const std::string axis = parameters.add("axis", list(circle.axis, plain));
  std::string there;
  std::string back;
  if (const std::string centre = list(circle.centre, number); centre != "[0, 0, 0]") {
    const std::string name = parameters.add("centre", centre);
    there = fmt::format("translate({}) ", name);
    back = fmt::format("translate(-{}) ", name);
  }
  return fmt::format("for (i = [0 : {} - 1]) {}rotate(a = i * {}, v = {}) {}", count, there, angle, axis, back);
}

const char* way_of(const decltype(script::Pattern::motion)& motion) {
  return std::visit(Overloaded{[](const script::LinePattern&) { return "at equal steps"; },
                               [](const script::GridPattern&) { return "at equal steps in two directions"; },
                               [](const script::CirclePattern&) { return "at equal angles about an axis"; }},
                    motion);
}

}  // namespace

Loops loops_of(const script::Plan& plan, const PrimitiveSet& primitives) {
  std::map<PrimitiveIndex, int> uses;
  for (const script::Step& step : plan.steps) {
    if (step.kind == Kind::primitive) ++uses[step.primitive];
  }
  constexpr double k_tolerance = 1e-6;  // of the model's size: more than rounding, less than any measurement
  const double tolerance = k_tolerance * plan.everything.sizes().maxCoeff();
  Loops loops;
  for (const script::Step& step : plan.steps) {
    const std::vector<std::size_t>& united = step.kind == Kind::union_of ? step.kept : step.removed;
    std::vector<PrimitiveIndex> candidates;
    for (const std::size_t operand : united) {
      const script::Step& one = plan.steps[operand];
      if (one.kind == Kind::primitive && uses[one.primitive] == 1) candidates.push_back(one.primitive);
    }
    for (script::Pattern& pattern : script::find_patterns(primitives, candidates, tolerance)) {
      loops.replaced.insert(pattern.members.begin() + 1, pattern.members.end());
      const PrimitiveIndex first = pattern.members.front();
      loops.first.emplace(first, std::move(pattern));
    }
  }
  return loops;
}

std::string loop_over(const script::Pattern& pattern, const std::vector<std::string>& names,
                      const script::NumberFormat& number, Parameters& parameters) {
  constexpr std::size_t k_most_named = 12;
  std::vector<std::string> others;
  for (std::size_t place = 1; place < pattern.members.size() && others.size() < k_most_named; ++place) {
    others.push_back(names[pattern.members[place]]);
  }
  const std::size_t unnamed = pattern.members.size() - 1 - others.size();
  parameters.remark(fmt::format("Repeated {}, as {}{}; these were off by {:.1g} at most.", way_of(pattern.motion),
                                fmt::join(others, ", "), unnamed > 0 ? fmt::format(" and {} more", unnamed) : "",
                                pattern.deviation));
  const auto loop = [&](const auto& motion) { return around(motion, pattern.members.size(), number, parameters); };
  return std::visit(loop, pattern.motion);
}

}  // namespace cloud2csg::openscad
