#include "io/meshes/threemf.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <iterator>
#include <limits>
#include <string_view>

#include "cloud2csg/error.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/scratch_file.hpp"

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

/// A zip archive that is written to a file, entry by entry.
class Archive {
 public:
  explicit Archive(const std::filesystem::path& file)
      : file_(file), zip_(zipOpen64(file.c_str(), APPEND_STATUS_CREATE)) {
    if (zip_ == nullptr) fail();
  }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive() {
    if (zip_ != nullptr) zipClose(zip_, nullptr);
  }

  void add(const char* name, std::string_view text) {
    // Without a time, so that the same mesh gives the same file.
    const zip_fileinfo no_time{};
    check(zipOpenNewFileInZip64(zip_, name, &no_time, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                Z_DEFAULT_COMPRESSION, text.size() > std::numeric_limits<std::int32_t>::max()));
    constexpr std::size_t k_most = std::size_t{1} << 30U;  // what fits the writer's argument
    for (std::size_t begin = 0; begin < text.size(); begin += k_most) {
      const std::string_view part = text.substr(begin, k_most);
      check(zipWriteInFileInZip(zip_, part.data(), static_cast<unsigned>(part.size())));
    }
    check(zipCloseFileInZip(zip_));
  }

  void close() {
    const int result = zipClose(zip_, nullptr);
    zip_ = nullptr;
    check(result);
  }

 private:
  void check(int result) const {
    if (result != ZIP_OK) fail();
  }
  [[noreturn]] void fail() const {
    throw Error({.file = file_.string(), .where = {}, .expected = "the archive cannot be written", .remedy = {}});
  }

  std::filesystem::path file_;
  zipFile zip_;
};

}  // namespace

std::string to_3mf(const TriangleMesh& mesh) {
  const ScratchFile scratch;
  Archive archive(scratch.path());
  archive.add("[Content_Types].xml", k_content_types);
  archive.add("_rels/.rels", k_relationships);
  archive.add("3D/3dmodel.model", model_text(mesh));
  archive.close();
  return read_text_file(scratch.path());
}

}  // namespace cloud2csg
