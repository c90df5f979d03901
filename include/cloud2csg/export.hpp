#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"

namespace cloud2csg {

/// Its fields: see the table.
struct OpenScadOptions {
  int facets = 64, mesh_resolution = 64;
  bool patterns = true;
  std::string comment = {};
};
void option_table(OptionsOf<OpenScadOptions>, auto&& field) {
  using O = OpenScadOptions;
  field(&O::facets, "facets", "OpenSCAD (.scad .csg): facets of a full circle. $fn, in .csg by $fa where that can be.",
        at_least(3));
  field(&O::mesh_resolution, "mesh_resolution",
        "Displaced and expression solids, which become polyhedra: cells along the longest side", at_least(4),
        k_library);
  field(&O::patterns, "patterns", ".scad: write what repeats at equal steps or angles, or mirrored, as loops",
        k_library);
  field(&O::comment, "comment", "Lines for the head of the file, such as the fit; without '//'", k_library);
}

/// An OpenSCAD program: the values of each primitive as named variables in a section of the customiser, a named module
/// a primitive, the tree with indentation, chains of the same operation as one block. Of three or more equal solids, or
/// equal combinations of up to 64, that are united, taken away or intersected, at equal steps or at equal angles about
/// an axis, to 1e-6 of the model's size, the first is written, in a loop; so it is of two combinations that are equal
/// or mirror images. Renders in OpenSCAD 2021.01 without warnings.
[[nodiscard]] std::string to_openscad(const Model& model, const OpenScadOptions& options = {});

/// The flat language that OpenSCAD calculates with (.csg): each solid by a matrix, numbers in place of names, no loops.
/// Circles have no number of facets of their own ($fn = 0), so that FreeCAD reads true cylinders and spheres; OpenSCAD
/// makes facets by angle, down to a length of 0.01. Circles so small that it would make fewer than `facets` have that
/// number, and 17 at least: FreeCAD reads those as round, too.
[[nodiscard]] std::string to_openscad_csg(const Model& model, const OpenScadOptions& options = {});

/// Its fields: see the table.
struct ScriptOptions {
  int facet_resolution = 16;
  std::string comment = {};
};
void option_table(OptionsOf<ScriptOptions>, auto&& field) {
  using O = ScriptOptions;
  field(&O::facet_resolution, k_facet_resolution);
  field(&O::comment, "comment", "Lines for the head of the file; without '#'", k_library);
}

/// A macro for FreeCAD (.FCMacro, Python): a document in which each primitive is an object with its sizes and its
/// placement, labelled with its id, and each operation one over others. In numbers that are read as they are here.
/// Displaced solids, expressions and polytopes have facets.
/// @throws Error when the solid is empty
[[nodiscard]] std::string to_freecad_macro(const Model& model, const ScriptOptions& options = {});

/// A script for CadQuery 2.2 or later (.py): the values of each primitive as named variables, then the solids, then the
/// operations; the result is `part`.
/// @throws Error when the solid is empty
[[nodiscard]] std::string to_cadquery(const Model& model, const ScriptOptions& options = {});

/// Its fields: see the table.
struct ExportOptions {
  OpenScadOptions openscad = {};
  ScriptOptions script = {};
  MeshingOptions meshing = {};
  BrepOptions brep = {};
  bool exact_meshes = true;
};
void option_table(OptionsOf<ExportOptions>, auto&& field) {
  using O = ExportOptions;
  field(&O::openscad, "openscad", "How .scad and .csg are written");
  field(&O::script, "script", "How .FCMacro and .py are written");
  field(&O::meshing, "meshing", "The mesh of .stl, .off, .obj and .3mf");
  field(&O::brep, "brep", "How .step, .stp and .brep are written");
  field(&O::exact_meshes, "exact_meshes",
        "Meshes of the exact solid, as near as a fiftieth of the cells of `meshing`. For trees of more than 100 "
        "leaves, for what has no exact surface, and where the exact solid has a fault or cannot be had, they are made "
        "by contouring in cells all the same.",
        {.opposite = "contour",
         .otherwise = "Meshes by contouring in cells, also where OpenCASCADE could make the exact solid: faster for "
                      "many primitives"});
}

/// What a file does not say of itself.
struct ExportReport {
  /// STEP, BREP, meshes and scripts know bounded solids only: one that goes on beyond its primitives (a lone
  /// half-space, a complement) is cut at this box around them. Absent when nothing was cut.
  std::optional<AlignedBox> cut_at = {};
  std::optional<BrepReport> brep = {};  ///< STEP and BREP
};

/// Writes a model by the file's ending: .json, .scad, .csg, .FCMacro, .py, .step, .stp, .brep, .stl, .off, .obj, .3mf,
/// .dot.
/// All but .json need a tree, STEP and BREP need OpenCASCADE (has_brep()).
/// Nothing half-written. @throws Error
ExportReport export_model(const std::filesystem::path& file, const Model& model, const ExportOptions& options = {},
                          const RunContext& run = {});

}  // namespace cloud2csg
