#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/run_context.hpp"

/// Solids bounded by exact surfaces, for CAD programs: STEP and BREP files and their meshes, by OpenCASCADE. A module
/// with OpenCASCADE is loaded on first use, so programs that need none do not pay for it.
namespace cloud2csg {

struct BrepOptions {
  std::string name = {};
  bool with_primitives = false;
  int facet_resolution = 16;
  double volume_tolerance = 1e-3, mesh_deviation = 3e-4;
};
/// Shared by all scripts and files of exact solids.
inline constexpr OptionField k_facet_resolution{
    "facet_resolution",
    "STEP, BREP, .FCMacro, .py: cells along the longest side of solids without exact surfaces, which are written with "
    "facets. These are displaced solids, expressions, and nodes whose Boolean operation fails. CAD kernels are slow "
    "with many facets.",
    {.range = from_to(4, 256)}};
void option_table(OptionsOf<BrepOptions>, auto&& field) {
  using O = BrepOptions;
  field(&O::name, "name", "Name of the part in the file; empty: the name of the file without its ending", k_library);
  field(&O::with_primitives, "with_primitives",
        "STEP: also write the primitives, as named components to build on. Off by default, since they cover the solid "
        "when the file is opened.");
  field(&O::facet_resolution, k_facet_resolution);
  field(&O::volume_tolerance, "volume_tolerance",
        "Share by which the volume of a node may differ from that of the tree before its operation counts as failed",
        above_to(0, 1), k_library);
  field(&O::mesh_deviation, "mesh_deviation",
        "Largest distance of mesh triangles from the surface, as a share of the model's extent", from_to(1e-6, 1),
        k_library);
}

/// A node of the tree whose exact solid failed, so that it is written with facets.
struct FailedNode {
  std::string node;  ///< as to_text() writes it, shortened when long
  std::string reason;
};

/// What the written file does not tell by itself.
struct BrepReport {
  double volume = 0;       ///< volume of the solid in the file
  double tree_volume = 0;  ///< volume of the tree, from samples of its implicit value
  double tree_volume_error = 0;
  bool is_valid = false;   ///< the kernel finds no fault in the solid
  std::size_t solids = 0;  ///< separate bodies
  std::size_t faces = 0;
  std::size_t healed_faces = 0;  ///< faces that were invalid before they were mended
  std::vector<PrimitiveIndex> faceted = {};
  std::vector<FailedNode> failed = {};
  /// The box at which an unbounded solid was cut.
  std::optional<AlignedBox> cut_at = {};

  /// Whether the solid is exact and valid: no node failed, nothing has facets, and the volume is the tree's.
  [[nodiscard]] bool is_exact(const BrepOptions& options) const;
  /// |volume - tree_volume| / tree_volume; 0 when both are empty.
  [[nodiscard]] double volume_difference() const;
};

/// Whether the library was built with OpenCASCADE and its module is found.
[[nodiscard]] bool has_brep();

/// Details behind has_brep(), for reports on an installation.
struct BrepSupport {
  bool is_built_in = false;
  bool lacks_opencascade = false;     ///< the module is there, but OpenCASCADE's own libraries are missing
  std::filesystem::path module = {};  ///< the loaded file; empty when none could be loaded
  std::string fault = {};
  std::string remedy = {};
};
/// Loads the module if there is one.
[[nodiscard]] BrepSupport brep_support();
/// Does not load the module.
[[nodiscard]] bool is_brep_built_in();

/// Checks before a run whether `file` can be written. @throws Error saying what is missing, and how to get it
void require_brep(const std::filesystem::path& file);

/// Writes the tree's solid as a STEP file (AP214, millimetres): one part of one or more solids, whose faces have the
/// names of their primitives. Primitives become exact solids; half-spaces reach to model_extent(). One Boolean
/// operation takes many operands, but only those whose boxes meet. Each result is checked for validity and volume,
/// tried again with growing tolerances, finally replaced by facets and reported. Never leaves a partial file. The
/// result does not depend on the number of threads.
/// @throws Error without OpenCASCADE, for an empty solid, a bad option, a file that cannot be written; Cancelled
BrepReport write_step(const std::filesystem::path& file, const Model& model, const BrepOptions& options = {},
                      const RunContext& run = {});

/// The same as a BREP file, OpenCASCADE's own format, without names and units.
BrepReport write_brep(const std::filesystem::path& file, const Model& model, const BrepOptions& options = {},
                      const RunContext& run = {});

struct BrepMesh {
  TriangleMesh mesh;
  BrepReport report;
};

/// The surface of the same solid as triangles: planes are flat, edges exact, and triangles as few as the deviation
/// allows. Closed where the solid is valid. The result does not depend on the number of threads.
/// @throws as write_step(), except for files
[[nodiscard]] BrepMesh mesh_brep(const Model& model, const BrepOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
