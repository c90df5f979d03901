#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"

namespace cloud2csg {

struct OpenScadOptions {
  int facets = 64, mesh_resolution = 64;
  bool patterns = true;
  std::string comment = {};
};
void option_table(OptionsOf<OpenScadOptions>, auto&& field) {
  using O = OpenScadOptions;
  field(&O::facets, "facets",
        "OpenSCAD (.scad .csg): facets of a full circle. Sets $fn; in .csg, sets $fa where possible.", at_least(3));
  field(&O::mesh_resolution, "mesh_resolution",
        "Cells along the longest side of displaced and expression solids, which become polyhedra", at_least(4),
        k_library);
  field(&O::patterns, "patterns", ".scad: write solids that repeat at equal steps or angles, or mirrored, as loops",
        k_library);
  field(&O::comment, "comment", "Comment lines for the head of the file, such as the fit, without '//'", k_library);
}

/// An OpenSCAD program with named variables for each primitive's values in a section of the customiser, a named module
/// per primitive, and the indented tree, a chain of one operation as one block. Operands become loops when three or
/// more equal solids (or combinations of up to 64 solids) stand at equal steps or angles about an axis, or two
/// combinations are equal or mirrored, to 1e-6 of the model's size. Renders in OpenSCAD 2021.01 without warnings.
[[nodiscard]] std::string to_openscad(const Model& model, const OpenScadOptions& options = {});

/// OpenSCAD's flat language (.csg): each solid has a matrix, with numbers instead of names and no loops. Circles have
/// $fn = 0, so that FreeCAD reads true cylinders and spheres. OpenSCAD makes their facets by angle, down to a length of
/// 0.01. Circles too small for `facets` facets that way get $fn = max(`facets`, 17), still round in FreeCAD.
[[nodiscard]] std::string to_openscad_csg(const Model& model, const OpenScadOptions& options = {});

struct ScriptOptions {
  int facet_resolution = 16;
  std::string comment = {};
};
void option_table(OptionsOf<ScriptOptions>, auto&& field) {
  using O = ScriptOptions;
  field(&O::facet_resolution, k_facet_resolution);
  field(&O::comment, "comment", "Comment lines for the head of the file, without '#'", k_library);
}

/// A FreeCAD macro (.FCMacro, Python). Each primitive is an object with sizes and placement, labelled with its id, and
/// each operation is an object over others. Numbers are exact. Displaced solids, expressions and polytopes have facets.
/// @throws Error when the solid is empty
[[nodiscard]] std::string to_freecad_macro(const Model& model, const ScriptOptions& options = {});

/// A script for CadQuery 2.2 or later (.py): variables of each primitive, solids, operations; the result is `part`.
/// @throws Error when the solid is empty
[[nodiscard]] std::string to_cadquery(const Model& model, const ScriptOptions& options = {});

struct ExportOptions {
  OpenScadOptions openscad = {};
  ScriptOptions script = {};
  MeshingOptions meshing = {};
  BrepOptions brep = {};
  bool exact_meshes = true;
};
void option_table(OptionsOf<ExportOptions>, auto&& field) {
  using O = ExportOptions;
  field(&O::openscad, "openscad", "Options of .scad and .csg files");
  field(&O::script, "script", "Options of .FCMacro and .py files");
  field(&O::meshing, "meshing", "Options of the meshes in .stl, .off, .obj and .3mf files");
  field(&O::brep, "brep", "Options of .step, .stp and .brep files");
  field(&O::exact_meshes, "exact_meshes",
        "Mesh the exact solid, with a deviation of a fiftieth of a cell of `meshing`. Contouring in cells is used "
        "instead for trees of more than 100 leaves, for solids without an exact surface, and where the exact solid has "
        "a fault or cannot be made.",
        {.opposite = "contour",
         .otherwise = "Mesh by contouring in cells, even where OpenCASCADE could make the exact solid: faster for many "
                      "primitives"});
}

/// What the written file does not tell by itself.
struct ExportReport {
  /// STEP, BREP, meshes and scripts hold bounded solids only. A solid that reaches beyond its primitives (a lone
  /// half-space, a complement) is cut at this box around them. Absent when nothing was cut.
  std::optional<AlignedBox> cut_at = {};
  std::optional<BrepReport> brep = {};  ///< STEP and BREP
};

/// Writes a model by the file's ending: .json, .scad, .csg, .FCMacro, .py, .step, .stp, .brep, .stl, .off, .obj, .3mf,
/// .dot. All but .json need a tree; STEP and BREP need OpenCASCADE (has_brep()). No partial file. @throws Error
ExportReport export_model(const std::filesystem::path& file, const Model& model, const ExportOptions& options = {},
                          const RunContext& run = {});

}  // namespace cloud2csg
