#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/run_context.hpp"

/// Solids bounded by exact surfaces, for CAD programs: STEP and BREP files, and meshes of them, by OpenCASCADE. Its
/// part of the library is a module that is loaded when first needed, so programs that write none do not pay for it.
namespace cloud2csg {

/// Its fields: see the table.
struct BrepOptions {
  std::string name = {};
  bool with_primitives = false;
  int facet_resolution = 16;
  double volume_tolerance = 1e-3, mesh_deviation = 3e-4;
};
/// Of all scripts and files of exact solids.
inline constexpr OptionField k_facet_resolution{
    "facet_resolution",
    "STEP, BREP, .FCMacro, .py: cells along the longest side of what has no exact surface, and has facets. Displaced "
    "solids, expressions, and nodes whose Boolean operation fails. Kernels of exact solids are slow with many.",
    {.range = from_to(4, 256)}};
void option_table(OptionsOf<BrepOptions>, auto&& field) {
  using O = BrepOptions;
  field(&O::name, "name", "Name of the part in the file; empty: the name of the file without its ending", k_library);
  field(&O::with_primitives, "with_primitives",
        "STEP: the primitives, too, as components with their names, for building on them. Off, since they cover the "
        "solid when the file is opened.");
  field(&O::facet_resolution, k_facet_resolution);
  field(
      &O::volume_tolerance, "volume_tolerance",
      "The part of its volume by which a node may differ from what the tree says before its operation counts as failed",
      above_to(0, 1), k_library);
  field(&O::mesh_deviation, "mesh_deviation",
        "How far the triangles of meshes may be from the surface, as a part of the model's extent", from_to(1e-6, 1),
        k_library);
}

/// A node of the tree whose exact solid could not be had, and which is written with facets instead.
struct FailedNode {
  std::string node;    ///< as to_text() writes it, shortened when long
  std::string reason;  ///< one line
};

/// What was written, as far as the file does not say.
struct BrepReport {
  double volume = 0;             ///< of the solid as it is in the file
  double tree_volume = 0;        ///< of the tree, by samples of its implicit value
  double tree_volume_error = 0;  ///< standard error of that
  bool is_valid = false;         ///< whether the kernel finds no fault in the solid
  std::size_t solids = 0;        ///< separate bodies
  std::size_t faces = 0;
  std::size_t healed_faces = 0;              ///< faces that were invalid before they were mended
  std::vector<PrimitiveIndex> faceted = {};  ///< primitives without exact surfaces
  std::vector<FailedNode> failed = {};
  /// The box at which a solid without ends was cut.
  std::optional<AlignedBox> cut_at = {};

  /// Whether the solid is exact and without fault: nothing failed, nothing has facets, the volume is the tree's.
  [[nodiscard]] bool is_exact(const BrepOptions& options) const;
  /// |volume - tree_volume| as a part of the tree's; 0 when both are empty.
  [[nodiscard]] double volume_difference() const;
};

/// Whether files can be written: the library was built with OpenCASCADE, and its module is found.
[[nodiscard]] bool has_brep();

/// What has_brep() depends on, for reports on an installation.
struct BrepSupport {
  bool is_built_in = false;           ///< the library was built with OpenCASCADE
  bool lacks_opencascade = false;     ///< its module is there, OpenCASCADE's own libraries are not
  std::filesystem::path module = {};  ///< the file that was loaded; empty when none could be
  std::string fault = {};             ///< why not
  std::string remedy = {};
};
/// Loads the module, but where there is none to load.
[[nodiscard]] BrepSupport brep_support();
/// Without loading it.
[[nodiscard]] bool is_brep_built_in();

/// For a program that wants to know before it starts what would keep `file` from being written.
/// @throws Error saying what is missing, and how to get it
void require_brep(const std::filesystem::path& file);

/// The tree's solid as a STEP file (AP214, millimetres): one part, of one or more solids, whose faces have the names of
/// the primitives that they come from. Primitives become exact solids, half-spaces reach to model_extent(). Booleans
/// are made of many operands at a time, of those only whose boxes meet; each result is checked for validity and volume,
/// tried again with growing tolerances, and in the end replaced by facets and reported. Nothing half-written.
/// The same for any number of threads.
/// @throws Error when OpenCASCADE is missing, for options out of range, when the file cannot be written or the solid is
/// empty; Cancelled
BrepReport write_step(const std::filesystem::path& file, const Model& model, const BrepOptions& options = {},
                      const RunContext& run = {});

/// The same as a BREP file, OpenCASCADE's own: no names, no units.
BrepReport write_brep(const std::filesystem::path& file, const Model& model, const BrepOptions& options = {},
                      const RunContext& run = {});

struct BrepMesh {
  TriangleMesh mesh;
  BrepReport report;
};

/// The surface of the same solid as triangles: planes are flat and edges true, and as few triangles as the deviation
/// allows. Closed, where the solid is valid. The same for any number of threads.
/// @throws as write_step(), but for files
[[nodiscard]] BrepMesh mesh_brep(const Model& model, const BrepOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
