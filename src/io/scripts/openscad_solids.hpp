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

/// Words of the language, its modules, and the modules that every file of ours may define.
[[nodiscard]] const std::set<std::string>& reserved_words();

/// [x, y, z]
[[nodiscard]] std::string list(const Eigen::Vector3d& vector, const script::NumberFormat& number);

/// Angles for rotate() that turn the solid as its pose does. A solid of revolution about z is turned about two axes
/// only.
[[nodiscard]] Eigen::Vector3d rotation_angles(const Primitive& primitive);

/// The named values of a solid: a section of OpenSCAD's customiser.
class Parameters {
 public:
  /// Both must outlive it.
  Parameters(const std::string& solid, script::UniqueNames& variables) : solid_(solid), variables_(variables) {}

  /// Adds `<solid>_<what> = <value>;` and gives the variable's name.
  [[nodiscard]] std::string add(const std::string& what, const std::string& value);

  /// Adds a comment.
  void remark(const std::string& text) { lines_ += script::comment(text, "// "); }

  /// `/* [solid] */` and the values; nothing when there are none.
  [[nodiscard]] std::string section() const;

 private:
  const std::string& solid_;
  script::UniqueNames& variables_;
  std::string lines_ = {};
};

struct SolidContext {
  AlignedBox everything;  ///< finite; half-spaces reach to its ends
  int mesh_resolution;    ///< of solids that OpenSCAD has no name for
  script::NumberFormat number;
  int facets;  ///< of a full circle
};

/// Where the profile of a torus touches the axis the solid is no 2-manifold, which OpenSCAD refuses: the radius of the
/// pinhole that is left there, in units of the minor radius. Absent for a torus with a hole.
[[nodiscard]] std::optional<double> pinhole_of(const Torus& torus, int facets);

/// Whether the solid becomes a long list of triangles: displaced solids and expressions.
[[nodiscard]] bool needs_mesh(const Primitive& primitive);

/// The OpenSCAD statement for a primitive, in place, by the values that it adds to `parameters`:
/// `translate(bore_position) cylinder(h = bore_height, r = bore_radius, center = true);`
[[nodiscard]] std::string solid(const Primitive& primitive, const SolidContext& context, Parameters& parameters);

/// `points = ...,<separator>faces = ...`, as polyhedron() takes them.
[[nodiscard]] std::string facet_lists(const brep::Facets& facets, const script::NumberFormat& number,
                                      const std::string& separator);

}  // namespace cloud2csg::openscad
