#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cloud2csg/brep.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"

namespace cloud2csg {

struct OpenScadOptions {
  int facets = 64;           ///< $fn: how many facets a circle has
  int mesh_resolution = 64;  ///< for displaced and expression solids, which become polyhedra
  std::string comment = {};  ///< lines for the head of the file, e.g. the fit; without "//"
};

/// An OpenSCAD program: a named module a primitive, the tree with indentation, chains of the same operation as one
/// block. Renders in OpenSCAD 2021.01 without warnings.
[[nodiscard]] std::string to_openscad(const CsgTree& tree, const PrimitiveSet& primitives,
                                      const OpenScadOptions& options = {});

struct ExportOptions {
  OpenScadOptions openscad = {};
  MeshingOptions meshing = {};
  BrepOptions brep = {};
};

/// What a file does not say of itself.
struct ExportReport {
  /// STEP, BREP, meshes and OpenSCAD know bounded solids only: one that goes on beyond its primitives (a lone
  /// half-space, a complement) is cut at this box around them. Absent when nothing was cut.
  std::optional<AlignedBox> cut_at = {};
  std::optional<BrepReport> brep = {};  ///< STEP and BREP
};

/// Writes a model by the file's ending: .json, .scad, .step, .stp, .brep, .stl, .off, .obj, .dot. All but .json need a
/// tree, STEP and BREP need OpenCASCADE (has_brep()).
/// Nothing half-written. @throws Error
ExportReport export_model(const std::filesystem::path& file, const Model& model, const ExportOptions& options = {},
                          const RunContext& run = {});

}  // namespace cloud2csg
