#include "io/scripts/openscad_loops.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "core/primitive/shape.hpp"
#include "io/scripts/openscad_solids.hpp"

namespace cloud2csg::openscad {
namespace {

using Kind = script::Step::Kind;

constexpr std::size_t k_most_solids = 64;  ///< in one member; patterns of larger members are rare

struct Head {
  std::string variables;
  std::string motion;
};

std::string count_of(std::size_t members, Parameters& parameters) {
  return parameters.add("count", fmt::format("{}", members));
}

Head head_of(const script::LinePattern& line, std::size_t members, const script::NumberFormat& number,
             Parameters& parameters) {
  const std::string count = count_of(members, parameters);
  return {fmt::format("i = [0 : {} - 1]", count),
          fmt::format("translate(i * {})", parameters.add("step", list(line.step, number)))};
}

Head head_of(const script::GridPattern& grid, std::size_t members, const script::NumberFormat& number,
             Parameters& parameters) {
  const std::string columns = parameters.add("columns", fmt::format("{}", grid.columns));
  const std::string rows = parameters.add("rows", fmt::format("{}", members / grid.columns));
  const std::string step = parameters.add("step", list(grid.step, number));
  return {fmt::format("i = [0 : {} - 1], j = [0 : {} - 1]", columns, rows),
          fmt::format("translate(i * {} + j * {})", step, parameters.add("row_step", list(grid.row_step, number)))};
}

Head head_of(const script::CirclePattern& circle, std::size_t members, const script::NumberFormat& number,
             Parameters& parameters) {
  const std::string count = count_of(members, parameters);
  const script::NumberFormat plain(1.0);
  // A full circle stays full when the count changes.
  const std::string angle = circle.is_full ? "360 / " + count : parameters.add("angle", plain(circle.angle_deg));
  const std::string axis = parameters.add("axis", list(circle.axis, plain));
  std::string there;
  std::string back;
  if (const std::string centre = list(circle.centre, number); centre != "[0, 0, 0]") {
    const std::string name = parameters.add("centre", centre);
    there = fmt::format("translate({}) ", name);
    back = fmt::format(" translate(-{})", name);
  }
  return {fmt::format("i = [0 : {} - 1]", count),
          fmt::format("{}rotate(a = i * {}, v = {}){}", there, angle, axis, back)};
}

/// mirror() by a zero vector is the identity.
Head head_of(const script::MirrorPattern& mirror, std::size_t /*members*/, const script::NumberFormat& number,
             Parameters& parameters) {
  const std::string normal = parameters.add("mirror", list(mirror.plane.normal, script::NumberFormat(1.0)));
  std::string shift;
  if (const std::string offset = number(mirror.plane.offset); offset != "0") {
    shift = fmt::format("translate(2 * i * {} * {}) ", parameters.add("mirror_offset", offset), normal);
  }
  return {"i = [0, 1]", fmt::format("{}mirror(i * {})", shift, normal)};
}

const char* way_of(const decltype(script::Pattern::motion)& motion) {
  return std::visit(Overloaded{[](const script::LinePattern&) { return "at equal steps"; },
                               [](const script::GridPattern&) { return "at equal steps in two directions"; },
                               [](const script::CirclePattern&) { return "at equal angles about an axis"; },
                               [](const script::MirrorPattern&) { return "as in a mirror"; }},
                    motion);
}

/// Number of solids in a step, and whether a pattern may contain all of them.
struct Weight {
  std::size_t solids = 0;
  bool can_repeat = true;
};

class LoopFinder {
 public:
  LoopFinder(const script::Plan& plan, const PrimitiveSet& primitives) : plan_(plan), primitives_(primitives) {
    constexpr double k_tolerance = 1e-6;  // relative to the model: more than rounding, less than any measurement
    tolerance_ = k_tolerance * plan.everything.sizes().maxCoeff();
    weigh();
  }

  Loops find() {
    // Goes from users to operands, because replaced members write none of theirs.
    for (std::size_t index = plan_.steps.size(); index-- > 0;) {
      const script::Step& step = plan_.steps[index];
      if (loops_.replaced.contains(index)) {
        if (step.kind == Kind::primitive) loops_.unwritten.insert(step.primitive);
        for (const auto* operands : {&step.kept, &step.removed}) {
          loops_.replaced.insert(operands->begin(), operands->end());
        }
        continue;
      }
      find_among(step.kept, step.kind == Kind::common);
      find_among(step.removed, false);
    }
    return std::move(loops_);
  }

 private:
  void weigh() {
    std::map<PrimitiveIndex, int> uses;
    for (const script::Step& step : plan_.steps) {
      if (step.kind == Kind::primitive) ++uses[step.primitive];
    }
    weights_.reserve(plan_.steps.size());
    for (const script::Step& step : plan_.steps) {
      Weight weight{.solids = 0, .can_repeat = step.kind != Kind::everything};
      if (step.kind == Kind::primitive) {
        weight = {.solids = 1,
                  .can_repeat = script::can_repeat(primitives_[step.primitive]) && uses[step.primitive] == 1};
      }
      for (const auto* operands : {&step.kept, &step.removed}) {
        for (const std::size_t operand : *operands) {
          weight.solids += weights_[operand].solids;
          weight.can_repeat = weight.can_repeat && weights_[operand].can_repeat;
        }
      }
      weights_.push_back(weight);
    }
  }

  void find_among(const std::vector<std::size_t>& operands, bool is_intersection) {
    std::vector<std::size_t> steps;
    std::vector<script::Part> parts;
    for (const std::size_t operand : operands) {
      const Weight& weight = weights_[operand];
      if (!weight.can_repeat || weight.solids == 0 || weight.solids > k_most_solids) continue;
      steps.push_back(operand);
      parts.push_back(part_of(operand));
    }
    for (script::Pattern& pattern : script::find_patterns(parts, tolerance_)) {
      for (std::size_t& member : pattern.members) member = steps[member];
      loops_.replaced.insert(pattern.members.begin() + 1, pattern.members.end());
      const std::size_t first = pattern.members.front();
      loops_.first.emplace(first, Loop{.pattern = std::move(pattern), .is_intersection = is_intersection});
    }
  }

  /// The recursion is no deeper than the number of solids.
  [[nodiscard]] script::Part part_of(std::size_t index) const {
    const script::Step& step = plan_.steps[index];
    if (step.kind == Kind::primitive) return {.solid = primitives_[step.primitive]};
    script::Part part{.kind = step.kind == Kind::union_of ? script::Part::Kind::united : script::Part::Kind::common};
    for (const std::size_t operand : step.kept) part.kept.push_back(part_of(operand));
    for (const std::size_t operand : step.removed) part.removed.push_back(part_of(operand));
    return part;
  }

  const script::Plan& plan_;
  const PrimitiveSet& primitives_;
  double tolerance_ = 0;
  std::vector<Weight> weights_ = {};
  Loops loops_ = {};
};

}  // namespace

Loops loops_of(const script::Plan& plan, const PrimitiveSet& primitives) {
  return LoopFinder(plan, primitives).find();
}

std::vector<PrimitiveIndex> primitives_of_step(const script::Plan& plan, std::size_t step) {
  std::vector<PrimitiveIndex> found;
  std::vector<std::size_t> to_do{step};
  while (!to_do.empty()) {
    const script::Step& one = plan.steps[to_do.back()];
    to_do.pop_back();
    if (one.kind == Kind::primitive) found.push_back(one.primitive);
    to_do.insert(to_do.end(), one.removed.rbegin(), one.removed.rend());
    to_do.insert(to_do.end(), one.kept.rbegin(), one.kept.rend());
  }
  return found;
}

std::string loop_over(const Loop& loop, const std::vector<std::string>& names, const script::NumberFormat& number,
                      Parameters& parameters) {
  constexpr std::size_t k_most_named = 12;
  const script::Pattern& pattern = loop.pattern;
  const std::size_t named = std::min(names.size() - 1, k_most_named);
  const std::vector<std::string> others(names.begin() + 1, names.begin() + 1 + static_cast<std::ptrdiff_t>(named));
  const std::size_t unnamed = names.size() - 1 - named;
  parameters.remark(fmt::format("Repeated {}, as {}{}; these were off by {:.1g} at most.", way_of(pattern.motion),
                                fmt::join(others, ", "), unnamed > 0 ? fmt::format(" and {} more", unnamed) : "",
                                pattern.deviation));
  const Head head = std::visit(
      [&](const auto& motion) { return head_of(motion, pattern.members.size(), number, parameters); }, pattern.motion);
  return fmt::format("{} ({}) {} ", loop.is_intersection ? "intersection_for" : "for", head.variables, head.motion);
}

}  // namespace cloud2csg::openscad
