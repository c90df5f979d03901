#include <algorithm>
#include <string>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/file_ending.hpp"
#include "io/clouds/ply_header.hpp"

namespace cloud2csg {

Shape3d read_shape(const std::filesystem::path& file) {
  const std::string ending = lower_ending(file);
  const auto is_one_of = [&ending](std::initializer_list<const char*> endings) {
    return std::ranges::find(endings, ending) != endings.end();
  };
  if (is_one_of({".json", ".scad", ".csg"})) return {.model = read_model(file)};
  if (is_one_of({".stl", ".off", ".obj", ".3mf", ".glb"})) return {.mesh = read_mesh(file)};
  if (ending == ".ply" && ply_has_faces(file)) return {.mesh = read_mesh(file)};
  if (is_one_of({".ply", ".pcd", ".xyz", ".xyzn", ".txt", ".pts"})) return {.cloud = read_point_cloud(file)};
  if (!std::filesystem::exists(file)) (void)read_text_file(file);  // says why
  throw Error({.file = file.string(),
               .where = {},
               .expected =
                   "expected a model (.json, .scad, .csg), a mesh (.stl, .off, .obj, .3mf, .glb, .ply with faces) or a "
                   "point cloud (.ply, .pcd, .xyz, .xyzn, .txt, .pts)",
               .remedy = "convert the file"});
}

}  // namespace cloud2csg
