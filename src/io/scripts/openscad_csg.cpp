#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "cloud2csg/export.hpp"
#include "core/primitive/profile.hpp"
#include "io/scripts/openscad_blocks.hpp"
#include "io/scripts/openscad_solids.hpp"
#include "io/scripts/script_plan.hpp"
#include "io/scripts/script_solids.hpp"

namespace cloud2csg {
namespace {

using Kind = script::Step::Kind;

/// Writes a solid in its own frame.
class FlatBody {
 public:
  FlatBody(const script::NumberFormat& number, int facets) : number_(number), facets_(facets) {}

  std::string operator()(const Box& box) const {
    return fmt::format("cube(size = {}, center = true);", openscad::list(box.size, number_));
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("sphere({}, r = {});", round(sphere.radius), number_(sphere.radius));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return frustum(cylinder.height, cylinder.radius, cylinder.radius);
  }
  std::string operator()(const Cone& cone) const { return frustum(cone.height, cone.radius_bottom, cone.radius_top); }
  std::string operator()(const Torus& torus) const {
    std::string profile = fmt::format("multmatrix({}) {{ circle({}, r = {}); }}", shift(torus.major_radius, 0),
                                      round(torus.minor_radius), number_(torus.minor_radius));
    if (const std::optional<double> pinhole = openscad::pinhole_of(torus, facets_)) {
      const double side = 2 * torus.minor_radius;
      profile =
          fmt::format("intersection() {{ {} multmatrix({}) {{ square(size = [{}, {}], center = false); }} }}", profile,
                      shift(*pinhole * torus.minor_radius, -torus.minor_radius), number_(side), number_(side));
    }
    return fmt::format("rotate_extrude({}, convexity = 2) {{ {} }}", round(torus.major_radius + torus.minor_radius),
                       profile);
  }
  std::string operator()(const brep::SweptProfile& swept) const {
    const std::string profile = profile_text(swept.regions);
    if (swept.height) {
      return fmt::format("linear_extrude(height = {}, center = true, convexity = 2) {{ {} }}", number_(*swept.height),
                         profile);
    }
    double radius = 0;
    for (const ProfileRegion& region : swept.regions) {
      radius = std::max(radius, bounds_of(region.outline).max().x());
    }
    const std::string angle =
        swept.angle_deg < 360 ? fmt::format("angle = {}, ", script::NumberFormat(1.0)(swept.angle_deg)) : "";
    return fmt::format("rotate_extrude({}{}, convexity = 2) {{ {} }}", angle, round(radius), profile);
  }
  /// FreeCAD requires a convexity.
  std::string operator()(const brep::Facets& facets) const {
    return fmt::format("polyhedron({}, convexity = 2);", openscad::facet_lists(facets, number_, " "));
  }

 private:
  [[nodiscard]] std::string profile_text(const std::vector<ProfileRegion>& regions) const {
    std::string text;
    for (const ProfileRegion& region : regions) {
      if (!text.empty()) text += " ";
      if (region.holes.empty()) {
        text += path_text(region.outline);
        continue;
      }
      text += fmt::format("difference() {{ {}", path_text(region.outline));
      for (const auto& hole : region.holes) text += " " + path_text(hole);
      text += " }";
    }
    return text;
  }

  [[nodiscard]] std::string path_text(const std::vector<ProfileSegment>& path) const {
    if (is_circle(path)) {
      return fmt::format("multmatrix({}) {{ circle({}, r = {}); }}",
                         shift(path.front().centre.x(), path.front().centre.y()), round(path.front().radius),
                         number_(path.front().radius));
    }
    std::vector<std::string> corners;
    for (const ProfileSegment& s : path) {
      const double share = std::abs(s.angle) / (2 * std::numbers::pi);
      const int steps = s.is_arc() ? std::max(2, static_cast<int>(std::lround(facets_ * share))) : 1;
      for (int k = 0; k < steps; ++k) {
        const Eigen::Vector2d corner = s.at(static_cast<double>(k) / steps);
        corners.push_back(fmt::format("[{}, {}]", number_(corner.x()), number_(corner.y())));
      }
    }
    return fmt::format("polygon(points = [{}], paths = undef, convexity = 2);", fmt::join(corners, ", "));
  }

  /// As few facets as requested. FreeCAD keeps a true circle for $fn = 0, or above 16 (its preference for the most
  /// facets). With $fn = 0, OpenSCAD makes no facet shorter than 0.01, so a small circle gets $fn of at least 17.
  [[nodiscard]] std::string round(double radius) const {
    constexpr double k_least_length = 0.01;
    constexpr int k_fewest_of_true_circle = 17;
    const bool is_by_angle = 2 * std::numbers::pi * radius >= facets_ * k_least_length;
    return fmt::format("$fn = {}, $fa = {:.10g}, $fs = {}",
                       is_by_angle ? 0 : std::max(facets_, k_fewest_of_true_circle), 360.0 / facets_, k_least_length);
  }

  [[nodiscard]] std::string shift(double x, double y) const {
    return fmt::format("[[1, 0, 0, {}], [0, 1, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]]", number_(x), number_(y));
  }

  [[nodiscard]] std::string frustum(double height, double bottom, double top) const {
    return fmt::format("cylinder({}, h = {}, r1 = {}, r2 = {}, center = true);", round(std::max(bottom, top)),
                       number_(height), number_(bottom), number_(top));
  }

  const script::NumberFormat& number_;
  int facets_;
};

/// All digits, so that a reader can recover the rotation from the matrix.
std::string matrix_text(const Pose& pose, const script::NumberFormat& number) {
  const Eigen::Matrix3d turn = pose.orientation.toRotationMatrix();
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    rows += fmt::format("[{}, {}, {}, {}], ", turn(row, 0) + 0.0, turn(row, 1) + 0.0, turn(row, 2) + 0.0,
                        number(pose.position[row]));
  }
  return "[" + rows + "[0, 0, 0, 1]]";
}

std::string statement(const brep::KernelSolid& solid, const script::NumberFormat& number, int facets) {
  return fmt::format("multmatrix({}) {{ {} }}", matrix_text(solid.pose, number),
                     std::visit(FlatBody(number, facets), solid.shape));
}

}  // namespace

std::string to_openscad_csg(const Model& model, const OpenScadOptions& options) {
  validate(options);
  const script::Plan plan = script::plan_script(model);
  const script::NumberFormat number(plan.everything.sizes().maxCoeff());
  const brep::KernelSolid everything{.shape = Box{.size = plan.everything.sizes()},
                                     .pose = {.position = plan.everything.center()}};
  const auto solid_of = [&](const Primitive& primitive) {
    // Keeps the minor radius, which solid_of() reduces for a torus without a hole.
    if (const auto* torus = std::get_if<Torus>(&primitive.shape); torus != nullptr && is_plain(primitive)) {
      return brep::KernelSolid{.shape = *torus, .pose = primitive.pose};
    }
    return script::solid_of(primitive, plan.everything, options.mesh_resolution);
  };
  const auto statement_of = [&](std::size_t step) {
    const bool is_primitive = plan.steps[step].kind == Kind::primitive;
    return statement(is_primitive ? solid_of(model.primitives[plan.steps[step].primitive]) : everything, number,
                     options.facets);
  };
  const auto no_loop = [](std::size_t /*step*/) { return std::optional<std::string>(""); };
  return script::comment(options.comment, "// ") +
         openscad::print_blocks(plan, {.statement_of = statement_of, .before = no_loop},
                                openscad::Intersections::in_pairs);
}

}  // namespace cloud2csg
