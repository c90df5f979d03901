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

/// All formats of files, in one table: how they are known, and what they are good for. Who reads or writes files asks
/// here which format one is of.
namespace cloud2csg {

/// What people want of a file.
enum class FileKind : std::uint8_t { cloud, mesh, model, script, solid, graph, page, picture, statistics };

/// "a point cloud"
[[nodiscard]] std::string_view kind_name(FileKind kind);

/// How a file begins.
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
    plain,      ///< a content that looks like it may be of another format, or of none
    read_only,  ///< is not written
  };

  Id id;
  FileKind kind;  ///< of a PLY file: `cloud`, also where it holds a mesh
  std::string_view name;
  std::array<std::string_view, 2> endings;  ///< as people write them; the second may be empty
  bool (*is_it)(const FileStart& start);    ///< whether a file that begins so may be replaced by one of this format
  Trait trait = Trait::none;
};

[[nodiscard]] std::span<const FileFormat> file_formats();

/// Stands, as a comment, at the head of each script and graph.
inline constexpr std::string_view k_program_mark = "Written by cloud2csg";

/// By its ending; null for one that is not known. A .json file is a model.
[[nodiscard]] const FileFormat* format_by_ending(const std::filesystem::path& file);
[[nodiscard]] bool has_ending_of(const std::filesystem::path& file, FileKind kind);

/// The endings of all formats of these kinds that are read or written, separated by blanks: for messages and help.
[[nodiscard]] std::string endings_read(std::initializer_list<FileKind> kinds);
[[nodiscard]] std::string endings_written(std::initializer_list<FileKind> kinds);

/// A file that is of another kind than what was asked for.
class WrongFile : public Error {
 public:
  WrongFile(Parts parts, FileKind found) : Error(std::move(parts)), found_(found) {}
  [[nodiscard]] FileKind found() const { return found_; }

 private:
  FileKind found_;
};

struct InputFile {
  FileFormat::Id format;
  FileKind kind;  ///< of a PLY file with faces: `mesh`
};

/// What to read a file as: the format that its ending says. One that cannot be looked into, as a pipe, is of that.
/// @throws WrongFile for what is, by content or else by ending, of none of these kinds; Error for a file that is
/// missing, an ending that is not known, or of another format than the content
[[nodiscard]] InputFile format_to_read(const std::filesystem::path& file, std::initializer_list<FileKind> kinds);

/// @throws Error for an ending that is of none of these kinds
[[nodiscard]] FileFormat::Id format_to_write(const std::filesystem::path& file, std::initializer_list<FileKind> kinds);

/// A file is overwritten by one of its format only: another under its name is somebody's work. Of those that people
/// write by hand, too, only what this program wrote is. One that is not there, is empty, or is no regular file may be
/// written. @throws Error where the content of a file is not of the format that its ending says
void check_overwriting(const std::filesystem::path& file, bool by_statistics = false);

}  // namespace cloud2csg
