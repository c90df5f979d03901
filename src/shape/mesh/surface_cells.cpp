#include "shape/mesh/surface_cells.hpp"

#include <cassert>
#include <limits>

namespace cloud2csg {
namespace {

constexpr std::uint32_t k_no_cell = std::numeric_limits<std::uint32_t>::max();

using LayerSigns = std::bitset<std::size_t{k_layer} * k_layer * k_layer>;

int layer_index(int x, int y, int z) {
  return x + k_layer * (y + k_layer * z);
}

/// Signs at all corners of a block's cells, including the first layer of its neighbours.
LayerSigns closed_signs(const SparseField& field, const Block& block) {
  LayerSigns inside;
  for (int z = 0; z < k_layer; ++z) {
    for (int y = 0; y < k_layer; ++y) {
      for (int x = 0; x < k_layer; ++x) {
        const bool own = x < k_block_cells && y < k_block_cells && z < k_block_cells;
        const Eigen::Vector3i corner(x, y, z);
        inside[static_cast<std::size_t>(layer_index(x, y, z))] =
            own ? block.inside[static_cast<std::size_t>(Block::local_index(corner))]
                : field.inside(block.first_cell + corner);
      }
    }
  }
  return inside;
}

void set_joined(SurfaceCell& cell, int face, bool joined) {
  const int bit = 1 << face;
  cell.joined = static_cast<FaceMask>(joined ? cell.joined | bit : cell.joined & ~bit);
}

/// Whether both curves through an ambiguous face belong to one sheet of the cell.
bool is_one_sheet(const SurfaceCell& cell, int face_number) {
  const Face face = face_of(face_number);
  const Loops loops = loops_of(cell.signs, cell.joined);
  return loops.loop_of(face.edges[0]) == loops.loop_of(face.edges[2]);
}

}  // namespace

SurfaceCells::SurfaceCells(const SparseField& field, const BoundedSolid& solid) : field_(field) {
  collect_cells();
  join_faces(solid);
  number_vertices();
}

void SurfaceCells::collect_cells() {
  cell_at_.assign(field_.blocks().size() * k_block_corners, k_no_cell);
  for (std::size_t slot = 0; slot < field_.blocks().size(); ++slot) {
    const Block& block = field_.blocks()[slot];
    block_begin_.push_back(cells_.size());
    const auto inside = closed_signs(field_, block);
    if (inside.none() || inside.all()) continue;
    for (int i = 0; i < k_block_corners; ++i) {
      const Eigen::Vector3i local(i % k_block_cells, i / k_block_cells % k_block_cells,
                                  i / (k_block_cells * k_block_cells));
      int signs = 0;
      for (int c = 0; c < 8; ++c) {
        const int corner = layer_index(local.x() + (c & 1), local.y() + ((c >> 1) & 1), local.z() + (c >> 2));
        signs |= inside[static_cast<std::size_t>(corner)] ? 1 << c : 0;
      }
      if (signs == 0 || signs == 0xff) continue;
      cell_at_[slot * k_block_corners + static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({.cell = block.first_cell + local, .signs = static_cast<CornerSigns>(signs)});
    }
  }
  block_begin_.push_back(cells_.size());
}

/// Joins ambiguous faces by the solid's sign at their centres, then repairs pinched surfaces.
void SurfaceCells::join_faces(const BoundedSolid& solid) {
  struct AmbiguousFace {
    SurfaceCell* below;
    SurfaceCell* above;
    int axis;
  };
  std::vector<AmbiguousFace> faces;
  Points centres;
  for (SurfaceCell& cell : cells_) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_ambiguous(cell.signs, face_of(2 * axis + 1))) continue;
      const SurfaceCell* above = find(cell.cell + Eigen::Vector3i::Unit(axis));
      assert(above != nullptr);
      faces.push_back({&cell, &cells_[static_cast<std::size_t>(above - cells_.data())], axis});
      Eigen::Vector3d centre = cell.cell.cast<double>() + Eigen::Vector3d::Constant(0.5);
      centre[axis] += 0.5;
      centres.push_back(field_.grid().to_world(centre));
    }
  }
  const std::vector<double> values = implicit_value(solid.tree, solid.primitives, centres);
  const auto join = [](const AmbiguousFace& face, bool joined) {
    set_joined(*face.below, 2 * face.axis + 1, joined);
    set_joined(*face.above, 2 * face.axis, joined);
  };
  for (std::size_t i = 0; i < faces.size(); ++i) join(faces[i], values[i] < 0);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool pinched =
        is_one_sheet(*faces[i].below, 2 * faces[i].axis + 1) && is_one_sheet(*faces[i].above, 2 * faces[i].axis);
    if (pinched) join(faces[i], !(values[i] < 0));
  }
}

void SurfaceCells::number_vertices() {
  std::vector<Loops> unjoined;
  unjoined.reserve(256);
  for (int signs = 0; signs < 256; ++signs) unjoined.push_back(loops_of(static_cast<CornerSigns>(signs), 0));
  for (SurfaceCell& cell : cells_) {
    cell.loops = cell.joined == 0 ? unjoined[cell.signs] : loops_of(cell.signs, cell.joined);
    cell.first_vertex = static_cast<std::uint32_t>(vertex_count_);
    vertex_count_ += static_cast<std::size_t>(cell.loops.count);
  }
}

const SurfaceCell* SurfaceCells::find(const Eigen::Vector3i& cell) const {
  if ((cell.array() < 0).any() || (cell.array() >= k_block_cells * field_.grid().blocks.array()).any()) return nullptr;
  const int slot = field_.slot_of(cell);
  if (slot < 0) return nullptr;
  const Eigen::Vector3i local = cell - field_.blocks()[static_cast<std::size_t>(slot)].first_cell;
  const auto position = static_cast<std::size_t>(slot) * k_block_corners;
  const std::uint32_t index = cell_at_[position + static_cast<std::size_t>(Block::local_index(local))];
  return index == k_no_cell ? nullptr : &cells_[index];
}

std::uint32_t SurfaceCells::vertex_at(const Eigen::Vector3i& cell, int edge) const {
  const SurfaceCell* found = find(cell);
  assert(found != nullptr);
  return found->first_vertex + static_cast<std::uint32_t>(found->loops.loop_of(edge));
}

}  // namespace cloud2csg
