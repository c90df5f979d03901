#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string_view>

#include "io/meshes/formats.hpp"
#include "io/meshes/zip_archive.hpp"

namespace cloud2csg {
namespace {

constexpr std::string_view k_content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";

constexpr std::string_view k_relationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

std::string model_text(const TriangleMesh& mesh) {
  std::string out =
      R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh>
<vertices>
)";
  const auto end = std::back_inserter(out);
  const Points& v = mesh.vertices;
  for (std::size_t i = 0; i < v.size(); ++i) {
    fmt::format_to(end, "<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", v.x[i], v.y[i], v.z[i]);
  }
  out += "</vertices>\n<triangles>\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    fmt::format_to(end, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
  }
  out += "</triangles>\n</mesh></object></resources>\n<build><item objectid=\"1\"/></build>\n</model>\n";
  return out;
}

}  // namespace

std::string to_3mf(const TriangleMesh& mesh) {
  const std::string model = model_text(mesh);
  return zip_archive(std::array{ZipEntry{"[Content_Types].xml", k_content_types},
                                ZipEntry{"_rels/.rels", k_relationships}, ZipEntry{"3D/3dmodel.model", model}});
}

}  // namespace cloud2csg
