#include "cloud2csg/compare.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg {

Shape3d read_shape(const std::filesystem::path& file) {
  switch (format_to_read(file, {FileKind::model, FileKind::mesh, FileKind::cloud}).kind) {
    case FileKind::model:
      return {.model = read_model(file)};
    case FileKind::mesh:
      return {.mesh = read_mesh(file)};
    default:
      return {.cloud = read_point_cloud(file)};
  }
}

}  // namespace cloud2csg
