#include "io/scripts/python_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/primitive/profile.hpp"
#include "io/scripts/script_solids.hpp"

namespace cloud2csg::script {
namespace {

using Kind = Step::Kind;

class BodyWriter {
 public:
  BodyWriter(const Plan& plan, const PrimitiveSet& primitives, int resolution, UniqueNames& names,
             const Dialect& dialect)
      : plan_(plan),
        primitives_(primitives),
        resolution_(resolution),
        names_(names),
        dialect_(dialect),
        name_of_(plan.steps.size()) {}

  PythonBody write() {
    write_solids();
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) write_step(i);
    const std::string& last = name_of_.back();
    if (last != k_part) body_.operations += fmt::format("{} = {}\n", k_part, last);
    return std::move(body_);
  }

 private:
  static constexpr const char* k_part = "part";

  void write_solids() {
    std::map<PrimitiveIndex, std::string> given;
    for (const PrimitiveIndex index : primitives_of(plan_)) {
      const Primitive& primitive = primitives_[index];
      const std::string& name = given[index] = names_.take(primitive.id);
      add_solid(name, primitive.id, solid_of(primitive, plan_.everything, resolution_));
    }
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) {
      const Step& step = plan_.steps[i];
      if (step.kind == Kind::primitive) name_of_[i] = given[step.primitive];
      if (step.kind == Kind::everything) name_of_[i] = write_everything();
    }
  }

  std::string write_everything() {
    const brep::KernelSolid box{.shape = Box{.size = plan_.everything.sizes()},
                                .pose = {.position = plan_.everything.center()}};
    std::string name = names_.take("everything");
    add_solid(name, "everything", box);
    return name;
  }

  void add_solid(const std::string& name, const std::string& label, const brep::KernelSolid& solid) {
    const SolidText text = dialect_.solid(name, label, solid);
    body_.parameters += text.parameters;
    body_.solids += text.statement;
  }

  void write_step(std::size_t index) {
    const Step& step = plan_.steps[index];
    if (step.kind == Kind::primitive || step.kind == Kind::everything) return;
    const std::vector<std::string> kept = names_of_operands(step.kept);
    if (kept.size() == 1 && step.removed.empty()) {
      name_of_[index] = kept.front();
      return;
    }
    const bool is_union = step.kind == Kind::union_of;
    const bool is_last = index + 1 == plan_.steps.size();
    const char* what = is_union ? "union" : step.removed.empty() ? "common" : "cut";
    name_of_[index] = is_last ? k_part : names_.take(fmt::format("{}_{}", what, ++operations_));
    std::string value = kept.size() == 1 ? kept.front() : is_union ? dialect_.unite(kept) : dialect_.common(kept);
    if (!step.removed.empty()) value = dialect_.cut(value, names_of_operands(step.removed));
    body_.operations += fmt::format("{} = {}\n", name_of_[index], value);
  }

  [[nodiscard]] std::vector<std::string> names_of_operands(const std::vector<std::size_t>& steps) const {
    std::vector<std::string> operands;
    operands.reserve(steps.size());
    for (const std::size_t step : steps) operands.push_back(name_of_[step]);
    return operands;
  }

  const Plan& plan_;
  const PrimitiveSet& primitives_;
  int resolution_;
  UniqueNames& names_;
  const Dialect& dialect_;
  std::vector<std::string> name_of_;  ///< by step
  int operations_ = 0;
  PythonBody body_ = {};
};

}  // namespace

PythonBody python_body(const Plan& plan, const PrimitiveSet& primitives, int facet_resolution, UniqueNames& names,
                       const Dialect& dialect) {
  if (is_empty(plan)) throw Error({.expected = "the solid is empty"});
  return BodyWriter(plan, primitives, facet_resolution, names, dialect).write();
}

std::string arguments(std::span<const std::string> operands) {
  constexpr std::size_t k_longest = 96;
  std::string lines;
  std::size_t length = 0;
  for (const std::string& operand : operands) {
    const bool is_first = lines.empty();
    if (!is_first) lines += length + operand.size() > k_longest ? ",\n    " : ", ";
    length = lines.ends_with("\n    ") ? 4 : length;
    lines += operand;
    length += operand.size() + 2;
  }
  return lines;
}

std::string exact(double number) {
  return fmt::format("{}", number + 0.0);  // no -0
}

std::string exact(const Eigen::Vector3d& vector) {
  return fmt::format("({}, {}, {})", exact(vector.x()), exact(vector.y()), exact(vector.z()));
}

std::string regions_text(std::span<const ProfileRegion> profile) {
  const auto corner_of = [](const ProfileSegment& s) {
    return fmt::format("({}, {}{})", exact(s.start.x()), exact(s.start.y()), s.is_arc() ? ", " + exact(s.bulge) : "");
  };
  const auto text_of = [&](const std::vector<ProfileSegment>& path) {
    std::vector<std::string> corners(path.size());
    std::ranges::transform(path, corners.begin(), corner_of);
    return fmt::format("[{}]", fmt::join(corners, ", "));
  };
  const auto region_text = [&](const ProfileRegion& region) {
    std::string text = text_of(region.outline);
    for (const auto& hole : region.holes) text += ",\n     " + text_of(hole);
    return fmt::format("[{}]", text);
  };
  std::vector<std::string> regions(profile.size());
  std::ranges::transform(profile, regions.begin(), region_text);
  return fmt::format("[{}]", fmt::join(regions, ",\n    "));
}

std::string shells_text(const brep::Facets& facets) {
  std::vector<std::string> shells;
  for (const brep::Facets& shell : shells_of(facets)) {
    std::vector<std::string> points;
    points.reserve(shell.corners.size());
    for (const Eigen::Vector3d& corner : shell.corners) points.push_back(exact(corner));
    std::vector<std::string> faces;
    faces.reserve(shell.faces.size());
    for (const auto& face : shell.faces) faces.push_back(fmt::format("({})", fmt::join(face, ", ")));
    shells.push_back(
        fmt::format("    (\n        [{}],\n        [{}],\n    ),\n", fmt::join(points, ", "), fmt::join(faces, ", ")));
  }
  return fmt::format("[\n{}]", fmt::join(shells, ""));
}

}  // namespace cloud2csg::script
