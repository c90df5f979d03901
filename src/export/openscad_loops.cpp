#include "export/openscad_loops.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <variant>

#include "export/openscad_text.hpp"
#include "primitive/overloaded.hpp"

namespace cloud2csg::openscad {
namespace {

using Kind = script::Step::Kind;

std::string around(const script::LinePattern& line, const std::string& count, const script::NumberFormat& number,
                   Parameters& parameters) {
  return fmt::format("for (i = [0 : {} - 1]) translate(i * {}) ", count,
                     parameters.add("step", list(line.step, number)));
}

std::string around(const script::CirclePattern& circle, const std::string& count, const script::NumberFormat& number,
                   Parameters& parameters) {
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
  std::vector<std::string> others;
  for (std::size_t place = 1; place < pattern.members.size(); ++place) others.push_back(names[pattern.members[place]]);
  const bool is_line = std::holds_alternative<script::LinePattern>(pattern.motion);
  parameters.remark(fmt::format("Repeated {}, as {}; these were off by {:.1g} at most.",
                                is_line ? "at equal steps" : "at equal angles about an axis", fmt::join(others, ", "),
                                pattern.deviation));
  const std::string count = parameters.add("count", fmt::format("{}", pattern.members.size()));
  return std::visit([&](const auto& motion) { return around(motion, count, number, parameters); }, pattern.motion);
}

}  // namespace cloud2csg::openscad
