#pragma once

#include <optional>
#include <set>
#include <string>

#include "cloud2csg/export.hpp"
#include "cloud2csg/primitive.hpp"
#include "io/scripts/script_text.hpp"
#include "io/step/kernel.hpp"

/// Solids, their parameters, and the words and numbers of an OpenSCAD program.
namespace cloud2csg::openscad {

/// OpenSCAD's keywords and modules, and the modules that our files may define.
[[nodiscard]] const std::set<std::string>& reserved_words();

/// [x, y, z]
[[nodiscard]] std::string list(const Eigen::Vector3d& vector, const script::NumberFormat& number);

/// Angles for rotate() that give the solid its orientation; for a solid of revolution about z, two angles suffice.
[[nodiscard]] Eigen::Vector3d rotation_angles(const Primitive& primitive);

/// The named values of a solid: a section of OpenSCAD's customiser.
class Parameters {
 public:
  /// Both must outlive this.
  Parameters(const std::string& solid, script::UniqueNames& variables) : solid_(solid), variables_(variables) {}

  /// Adds `<solid>_<what> = <value>;` and returns the variable's name.
  [[nodiscard]] std::string add(const std::string& what, const std::string& value);

  void remark(const std::string& text) { lines_ += script::comment(text, "// "); }

  /// `/* [solid] */` and the values; empty without values.
  [[nodiscard]] std::string section() const;

 private:
  const std::string& solid_;
  script::UniqueNames& variables_;
  std::string lines_ = {};
};

struct SolidContext {
  AlignedBox everything;  ///< finite; half-spaces extend to its ends
  int mesh_resolution;    ///< for solids without an OpenSCAD primitive
  script::NumberFormat number;
  int facets;  ///< in a full circle
};

/// Radius of the pinhole, in minor radii, for a torus that touches its axis. Without one it is not 2-manifold and
/// OpenSCAD refuses it. Absent for a torus with a hole.
[[nodiscard]] std::optional<double> pinhole_of(const Torus& torus, int facets);

/// Whether the solid becomes a long list of triangles: displaced solids and expressions.
[[nodiscard]] bool needs_mesh(const Primitive& primitive);

/// The placed statement for a primitive, by values that it adds to `parameters`:
/// `translate(bore_position) cylinder(h = bore_height, r = bore_radius, center = true);`. It may call path() of
/// scad::k_path_functions.
[[nodiscard]] std::string solid(const Primitive& primitive, const SolidContext& context, Parameters& parameters);

/// `points = ...,<separator>faces = ...`, as polyhedron() expects.
[[nodiscard]] std::string facet_lists(const brep::Facets& facets, const script::NumberFormat& number,
                                      const std::string& separator);

}  // namespace cloud2csg::openscad
