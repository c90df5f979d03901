#include <fmt/format.h>

#include <variant>

#include "cloud2csg/export.hpp"
#include "export/openscad_blocks.hpp"
#include "export/openscad_solids.hpp"
#include "export/openscad_text.hpp"
#include "export/script_plan.hpp"
#include "export/script_solids.hpp"

namespace cloud2csg {
namespace {

using Kind = script::Step::Kind;

/// Writes a solid in its own frame.
class FlatBody {
 public:
  FlatBody(const script::NumberFormat& number, int facets)
      : number_(number), round_(fmt::format("$fn = 0, $fa = {:.10g}, $fs = 0.01", 360.0 / facets)) {}

  std::string operator()(const Box& box) const {
    return fmt::format("cube(size = {}, center = true);", openscad::list(box.size, number_));
  }
  std::string operator()(const Sphere& sphere) const {
    return fmt::format("sphere({}, r = {});", round_, number_(sphere.radius));
  }
  std::string operator()(const Cylinder& cylinder) const {
    return frustum(cylinder.height, cylinder.radius, cylinder.radius);
  }
  std::string operator()(const Cone& cone) const { return frustum(cone.height, cone.radius_bottom, cone.radius_top); }
  std::string operator()(const Torus& torus) const {
    return fmt::format(
        "rotate_extrude({0}, convexity = 2) {{ multmatrix([[1, 0, 0, {1}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) "
        "{{ circle({0}, r = {2}); }} }}",
        round_, number_(torus.major_radius), number_(torus.minor_radius));
  }
  /// FreeCAD wants a convexity.
  std::string operator()(const brep::Facets& facets) const {
    return fmt::format("polyhedron({}, convexity = 2);", openscad::facet_lists(facets, number_, " "));
  }

 private:
  [[nodiscard]] std::string frustum(double height, double bottom, double top) const {
    return fmt::format("cylinder({}, h = {}, r1 = {}, r2 = {}, center = true);", round_, number_(height),
                       number_(bottom), number_(top));
  }

  const script::NumberFormat& number_;
  std::string round_;
};

/// All digits: a reader wants to find a rotation in the matrix.
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

std::string to_openscad_csg(const CsgTree& tree, const PrimitiveSet& primitives, const OpenScadOptions& options) {
  openscad::validate(options);
  const script::Plan plan = script::plan_script(tree, primitives);
  const script::NumberFormat number(plan.everything.sizes().maxCoeff());
  const brep::KernelSolid everything{.shape = Box{.size = plan.everything.sizes()},
                                     .pose = {.position = plan.everything.center()}};
  const auto statement_of = [&](std::size_t step) {
    const bool is_primitive = plan.steps[step].kind == Kind::primitive;
    const PrimitiveIndex index = plan.steps[step].primitive;
    return statement(
        is_primitive ? script::solid_of(primitives[index], plan.everything, options.mesh_resolution) : everything,
        number, options.facets);
  };
  return script::comment(options.comment, "// ") +
         openscad::print_blocks(plan, statement_of, openscad::Intersections::in_pairs);
}

}  // namespace cloud2csg
