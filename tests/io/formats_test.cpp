#include "io/formats/formats.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "cloud2csg/export.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {
namespace {

class Formats : public ::testing::Test {
 protected:
  Formats()
      : folder_(std::filesystem::temp_directory_path() / ("cloud2csg_formats_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Formats() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path file(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  [[nodiscard]] std::filesystem::path folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

TEST_F(Formats, HaveEndingsOfTheirOwn) {
  std::set<std::string_view> endings;
  for (const FileFormat& format : file_formats()) {
    for (const std::string_view ending : format.endings) {
      if (ending.empty() || format.kind == FileKind::statistics) continue;
      EXPECT_TRUE(endings.insert(ending).second) << ending;
      EXPECT_EQ(format_by_ending("a" + std::string(ending)), &format) << ending;
    }
  }
  EXPECT_EQ(format_by_ending("A.STL")->id, FileFormat::Id::stl);
  EXPECT_EQ(format_by_ending("a.fcmacro")->id, FileFormat::Id::freecad);
  EXPECT_EQ(format_by_ending("a.doc"), nullptr);
  EXPECT_EQ(format_by_ending("stl"), nullptr);
}

TEST_F(Formats, AreListedByWhatTheyAreFor) {
  EXPECT_EQ(endings_written({FileKind::mesh}), ".stl .off .obj .3mf");
  EXPECT_EQ(endings_read({FileKind::mesh}), ".stl .off .obj .3mf .glb .ply");
  EXPECT_EQ(endings_read({FileKind::cloud, FileKind::mesh}), ".ply .pcd .xyz .txt .xyzn .pts .stl .off .obj .3mf .glb");
}

TEST_F(Formats, WhatIsWrittenIsRecognisedAndReadAgain) {
  const PointCloud cloud{.positions = Points(3), .normals = {}};
  const Model model{.primitives = {{.id = "ball", .shape = Sphere{.radius = 1}}}, .tree = CsgTree::leaf(0)};
  for (const FileFormat& format : file_formats()) {
    const std::filesystem::path name = folder() / ("a" + std::string(format.endings[0]));
    const bool is_exported =
        format.kind == FileKind::model || format.kind == FileKind::mesh || format.kind == FileKind::script;
    if (format.trait == FileFormat::Trait::read_only || (format.kind != FileKind::cloud && !is_exported)) continue;
    if (is_exported) (void)export_model(name, model, {.meshing = {.resolution = 8}, .exact_meshes = false});
    if (format.id == FileFormat::Id::xyzn) continue;  // needs normals
    if (format.kind == FileKind::cloud) write_point_cloud(name, cloud);
    EXPECT_NO_THROW(check_overwriting(name)) << name;
    if (format.kind == FileKind::script) continue;
    EXPECT_EQ(format_to_read(name, {FileKind::cloud, FileKind::mesh, FileKind::model}).kind, format.kind) << name;
  }
}

TEST_F(Formats, PlyFilesWithFacesAreMeshes) {
  const std::string vertices = "ply\r\nformat ascii 1.0\r\ncomment element face 1\r\nelement vertex 1\r\n";
  const auto kind_of = [this](const std::string& content) {
    return format_to_read(file("a.ply", content), {FileKind::cloud, FileKind::mesh}).kind;
  };
  EXPECT_EQ(kind_of(vertices + "element face 0\r\nend_header\r\nelement face 1\r\n"), FileKind::cloud);
  EXPECT_EQ(kind_of(vertices + "element  face 010\r\nproperty list uchar int v\r\nend_header\r\n0\r\n0\r\n"),
            FileKind::mesh);
  EXPECT_EQ(kind_of(vertices + std::string(10'000, '\n') + "element face 1\nend_header\n"), FileKind::mesh);
  const std::filesystem::path mesh = file("b.ply", vertices + "element face 1\nend_header\n");
  EXPECT_NO_THROW((void)format_to_read(mesh, {FileKind::cloud})) << "its points are a cloud, too";
  EXPECT_THROW((void)format_to_read(file("c.ply", vertices + "end_header\n"), {FileKind::mesh}), WrongFile);
}

TEST_F(Formats, RowsOfNumbersProveNothing) {
  const InputFile told = format_to_read(file("a.off", "3 1 0\n0 0 0\n"), {FileKind::mesh});
  EXPECT_EQ(told.format, FileFormat::Id::off) << "for its reader to judge";
  EXPECT_EQ(format_to_read(file("a.obj", "anything"), {FileKind::mesh}).format, FileFormat::Id::obj);
}

TEST_F(Formats, AnyBytesAreLookedAt) {
  for (const std::string& bytes : {std::string(), std::string(5000, '\0'), std::string(5000, '\xff'),
                                   std::string("\n\n\n"), "{" + std::string(5000, ' '), std::string(5000, '1')}) {
    for (const FileFormat& format : file_formats()) {
      EXPECT_FALSE(format.is_it({.text = bytes, .file_size = bytes.size()}) && format.trait != FileFormat::Trait::plain)
          << format.name;
    }
  }
}

}  // namespace
}  // namespace cloud2csg
