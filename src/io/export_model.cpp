#include <fmt/format.h>

#include <string>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "core/base/files.hpp"
#include "io/formats/formats.hpp"
#include "shape/mesh/model_extent.hpp"

namespace cloud2csg {
namespace {

std::string text_of(const Eigen::Vector3d& corner) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", corner.x(), corner.y(), corner.z());
}

/// The comment at the head of a script: the caller's or else the model's, plus where the solid is cut.
std::string head_comment(std::string comment, const Model& model, const std::optional<AlignedBox>& cut) {
  if (comment.empty()) comment = model.description;
  if (cut) {
    comment += fmt::format("{}The solid is unbounded and is cut at {} to {}.", comment.empty() ? "" : "\n",
                           text_of(cut->min()), text_of(cut->max()));
  }
  return comment;
}

/// Adds the mark by which a later overwrite recognises the file as ours.
void write_marked(const std::filesystem::path& file, std::string_view comment, const std::string& text) {
  write_text_file(file, fmt::format("{} {}\n{}", comment, k_program_mark, text));
}

template <class Options>
ExportReport export_script(const std::filesystem::path& file, std::string_view comment, const Model& model,
                           Options options, std::string (*to_script)(const Model&, const Options&)) {
  ExportReport report{.cut_at = cut_at(model, model_extent(model))};
  options.comment = head_comment(std::move(options.comment), model, report.cut_at);
  write_marked(file, comment, to_script(model, options));
  return report;
}

/// The surface of the exact solid; absent without a kernel or when the solid has a fault.
std::optional<TriangleMesh> exact_surface(const Model& model, const ExportOptions& options, const RunContext& run) {
  constexpr std::size_t k_most_leaves = 100;  // the kernel is slow on larger trees
  constexpr double k_share_of_cell = 0.02;
  if (!options.exact_meshes || leaf_count(*model.tree) > k_most_leaves || !has_brep()) return std::nullopt;
  BrepOptions brep = options.brep;
  brep.mesh_deviation = k_share_of_cell / options.meshing.resolution;
  try {
    BrepMesh made = mesh_brep(model, brep, run);
    const bool is_right = made.report.is_exact(brep) && is_watertight(made.mesh);
    return is_right ? std::optional(std::move(made.mesh)) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

ExportReport export_mesh(const std::filesystem::path& file, const Model& model, const ExportOptions& options,
                         const RunContext& run) {
  const AlignedBox extent = model_extent(model);
  const std::optional<TriangleMesh> exact = exact_surface(model, options, run);
  const TriangleMesh mesh = exact ? *exact : mesh_surface(model, extent, options.meshing, run);
  if (mesh.triangles.empty()) {
    throw Error({.file = file.string(),
                 .expected = "expected a solid to mesh, found one that is empty or thinner than a cell",
                 .remedy = "check the tree, or give a larger `meshing.resolution`"});
  }
  write_mesh(file, mesh);
  return {.cut_at = cut_at(model, extent)};
}

}  // namespace

ExportReport export_model(const std::filesystem::path& file, const Model& model, const ExportOptions& options,
                          const RunContext& run) {
  validate(options);
  using Kind = FileKind;
  const FileFormat::Id format =
      format_to_write(file, {Kind::model, Kind::script, Kind::solid, Kind::mesh, Kind::graph});
  if (format != FileFormat::Id::json) (void)tree_of(model, file.string());
  switch (format) {
    case FileFormat::Id::json:
      write_model(file, model);
      return {};
    case FileFormat::Id::dot:
      write_marked(file, "//", to_graphviz(model));
      return {};
    case FileFormat::Id::scad:
      return export_script(file, "//", model, options.openscad, to_openscad);
    case FileFormat::Id::csg:
      return export_script(file, "//", model, options.openscad, to_openscad_csg);
    case FileFormat::Id::freecad:
      return export_script(file, "#", model, options.script, to_freecad_macro);
    case FileFormat::Id::cadquery:
      return export_script(file, "#", model, options.script, to_cadquery);
    case FileFormat::Id::step:
    case FileFormat::Id::brep: {
      const auto write = format == FileFormat::Id::brep ? write_brep : write_step;
      const BrepReport report = write(file, model, options.brep, run);
      return {.cut_at = report.cut_at, .brep = report};
    }
    default:
      return export_mesh(file, model, options, run);
  }
}

}  // namespace cloud2csg
