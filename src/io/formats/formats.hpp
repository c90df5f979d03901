#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "cloud2csg/error.hpp"

/// The one table of file formats: how to recognise them and what they hold. All readers and writers of files use it.
namespace cloud2csg {

enum class FileKind : std::uint8_t { cloud, mesh, model, script, solid, graph, page, picture, statistics };

/// "a point cloud"
[[nodiscard]] std::string_view kind_name(FileKind kind);

struct FileStart {
  std::string text;
  std::uintmax_t file_size = 0;
};

struct FileFormat {
  // clang-format off
  enum class Id : std::uint8_t {
    ply, pcd, xyz, xyzn, pts, json, scad, csg, freecad, cadquery, step, brep, stl, off, obj, threemf, glb, dot, html,
    png, statistics
  };
  // clang-format on
  enum class Trait : std::uint8_t {
    none,
    plain,  ///< content that looks like this format may be of another or of none
    read_only,
  };

  Id id;
  FileKind kind;  ///< for PLY `cloud`, even if the file holds a mesh
  std::string_view name;
  std::array<std::string_view, 2> endings;  ///< as people write them; the second may be empty
  bool (*is_it)(const FileStart& start);    ///< whether this format may replace a file that begins so
  Trait trait = Trait::none;
};

[[nodiscard]] std::span<const FileFormat> file_formats();

/// A comment at the head of each script and graph.
inline constexpr std::string_view k_program_mark = "Written by cloud2csg";

/// Null for an unknown ending. A .json file is a model.
[[nodiscard]] const FileFormat* format_by_ending(const std::filesystem::path& file);
[[nodiscard]] bool has_ending_of(const std::filesystem::path& file, FileKind kind);

/// All endings of these kinds that are read or written, separated by blanks; for messages and help.
[[nodiscard]] std::string endings_read(std::initializer_list<FileKind> kinds);
[[nodiscard]] std::string endings_written(std::initializer_list<FileKind> kinds);

class WrongFile : public Error {
 public:
  WrongFile(Parts parts, FileKind found) : Error(std::move(parts)), found_(found) {}
  [[nodiscard]] FileKind found() const { return found_; }

 private:
  FileKind found_;
};

struct InputFile {
  FileFormat::Id format;
  FileKind kind;  ///< `mesh` for a PLY file with faces
};

/// The format of a file by its ending, which the content must confirm. The content of a pipe is not inspected.
/// @throws WrongFile if the content, or else the ending, is of none of these kinds; Error for a missing file, an
/// unknown ending or one that disagrees with the content
[[nodiscard]] InputFile format_to_read(const std::filesystem::path& file, std::initializer_list<FileKind> kinds);

/// @throws Error for an ending of none of these kinds
[[nodiscard]] FileFormat::Id format_to_write(const std::filesystem::path& file, std::initializer_list<FileKind> kinds);

/// Refuses to overwrite a file of another format, which is somebody's work, or one that people also write by hand
/// unless this program wrote it. Missing, empty and irregular files may be written. @throws Error
void check_overwriting(const std::filesystem::path& file, bool by_statistics = false);

}  // namespace cloud2csg
