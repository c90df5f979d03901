#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "base/atomic_file.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "export/model_extent.hpp"

namespace cloud2csg {
namespace {

std::string lower_ending(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

const CsgTree& tree_of(const Model& model, const std::filesystem::path& file) {
  if (model.tree) return *model.tree;
  throw Error({.file = file.string(),
               .where = {},
               .expected = "expected a model with a tree, found primitives only",
               .remedy = "extract a tree first, or write .json"});
}

}  // namespace

void export_model(const std::filesystem::path& file, const Model& model, const ExportOptions& options,
                  const RunContext& run) {
  const std::string ending = lower_ending(file);
  if (ending == ".json") return write_model(file, model);
  if (ending == ".scad") {
    OpenScadOptions openscad = options.openscad;
    if (openscad.comment.empty()) openscad.comment = model.description;
    return write_text_file(file, to_openscad(tree_of(model, file), model.primitives, openscad));
  }
  if (ending == ".dot") return write_text_file(file, to_graphviz(tree_of(model, file), model.primitives));
  if (ending == ".stl" || ending == ".off" || ending == ".obj") {
    const CsgTree& tree = tree_of(model, file);
    const AlignedBox extent = model_extent(tree, model.primitives);
    return write_mesh(file, mesh_surface(tree, model.primitives, extent, options.meshing, run));
  }
  throw Error({.file = file.string(),
               .where = {},
               .expected = fmt::format("expected a file ending in .json, .scad, .dot, .stl, .off or .obj, found \"{}\"",
                                       ending),
               .remedy = {}});
}

}  // namespace cloud2csg
