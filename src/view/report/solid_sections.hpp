#pragma once

#include "cloud2csg/view.hpp"
#include "view/report/payload.hpp"

namespace cloud2csg {

/// The tree as it is shown (see shown_tree.hpp) and the meshes of its nodes: {"nodes": [{"operation", "primitive",
/// "children", "mesh"}], "meshes": [...]}. Nodes beyond the budget have the mesh null, empty solids one without
/// triangles. A primitive that is named twice has one mesh. @throws Cancelled
[[nodiscard]] Payload::Json solid_sections(const Model& model, const AlignedBox& extent, const ReportOptions& options,
                                           const RunContext& run, Payload& payload);

}  // namespace cloud2csg
