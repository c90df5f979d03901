#include "io/formats/formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <system_error>

#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

using Kinds = std::initializer_list<FileKind>;

bool is_one_of(FileKind kind, Kinds kinds) {
  return std::ranges::find(kinds, kind) != kinds.end();
}

FileStart start_of(const std::filesystem::path& file, std::size_t size = 4096) {
  std::error_code ignored;
  FileStart start{.text = std::string(size, '\0'), .file_size = std::filesystem::file_size(file, ignored)};
  std::ifstream content(file, std::ios::binary);
  content.read(start.text.data(), static_cast<std::streamsize>(size));
  start.text.resize(static_cast<std::size_t>(content.gcount()));
  return start;
}

/// Whether a PLY file announces faces and thus is a mesh.
bool has_faces(const std::filesystem::path& file) {
  constexpr std::size_t k_longest_header = std::size_t{1} << 20;
  static const std::regex k_faces("\nelement\\s+face\\s+0*[1-9]");
  const std::string text = start_of(file, k_longest_header).text;
  return std::regex_search(text.substr(0, text.find("end_header")), k_faces);
}

/// The format of the content, preferably `by_ending`. Null when neither ending nor content tells.
const FileFormat* format_by_content(const std::filesystem::path& file, const FileFormat* by_ending) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return by_ending;
  const FileStart start = start_of(file);
  if (by_ending != nullptr && by_ending->is_it(start)) return by_ending;
  for (const FileFormat& format : file_formats()) {
    if (format.trait != FileFormat::Trait::plain && format.is_it(start)) return &format;
  }
  return by_ending;
}

std::string endings_of(Kinds kinds, bool is_written) {
  std::string endings;
  for (const FileFormat& format : file_formats()) {
    if (!is_one_of(format.kind, kinds) || (is_written && format.trait == FileFormat::Trait::read_only)) continue;
    for (const std::string_view ending : format.endings) {
      if (!ending.empty()) endings += fmt::format("{}{}", endings.empty() ? "" : " ", ending);
    }
  }
  return endings;
}

/// "a point cloud (.ply .pcd) or a mesh (.stl .off)", or without the endings.
std::string names_of(Kinds kinds, bool with_endings) {
  std::string text;
  for (const FileKind kind : kinds) {
    text += fmt::format("{}{}", text.empty() ? "" : " or ", kind_name(kind));
    if (with_endings) text += fmt::format(" ({})", endings_read({kind}));
  }
  return text;
}

}  // namespace

std::string_view kind_name(FileKind kind) {
  constexpr std::array<std::string_view, 9> k_names{"a point cloud", "a mesh",         "a model",
                                                    "a script",      "an exact solid", "a graph",
                                                    "a page",        "a picture",      "statistics"};
  return k_names.at(static_cast<std::size_t>(kind));
}

const FileFormat* format_by_ending(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  for (const FileFormat& format : file_formats()) {
    const auto is_it = [&ending](std::string_view one) { return !one.empty() && lower_case(one) == ending; };
    if (std::ranges::any_of(format.endings, is_it)) return &format;
  }
  return nullptr;
}

bool has_ending_of(const std::filesystem::path& file, FileKind kind) {
  const FileFormat* const format = format_by_ending(file);
  return format != nullptr && format->kind == kind;
}

std::string endings_read(Kinds kinds) {
  const bool lacks_ply = is_one_of(FileKind::mesh, kinds) && !is_one_of(FileKind::cloud, kinds);
  return endings_of(kinds, false) + (lacks_ply ? " .ply" : "");
}

std::string endings_written(Kinds kinds) {
  return endings_of(kinds, true);
}

InputFile format_to_read(const std::filesystem::path& file, Kinds kinds) {
  Error::Parts parts{.file = file.string()};
  std::error_code failure;
  if (!std::filesystem::exists(std::filesystem::status(file, failure))) {
    parts.expected = fmt::format("cannot be read ({})", failure.message());
    parts.remedy = "check the path and its permissions";
    throw Error(std::move(parts));
  }
  const FileFormat* const named = format_by_ending(file);
  const FileFormat* const found = format_by_content(file, named);
  if (found == nullptr) {
    parts.expected = fmt::format("expected {}, found the ending '{}'", names_of(kinds, true),
                                 visible_text(file.extension().string(), k_longest_quote));
    parts.remedy = "rename or convert it";
    throw Error(std::move(parts));
  }
  const FileKind kind = found->id == FileFormat::Id::ply && has_faces(file) ? FileKind::mesh : found->kind;
  if (!is_one_of(kind, kinds) && !is_one_of(found->kind, kinds)) {
    parts.expected = fmt::format("expected {}, found {}{}", names_of(kinds, false), kind_name(kind),
                                 found == named ? "" : " by its content");
    throw WrongFile(std::move(parts), kind);
  }
  if (found != named) {
    parts.expected = fmt::format("its ending does not match its content ({})", found->name);
    parts.remedy = fmt::format("name it {}{}", file.stem().string(), found->endings[0]);
    throw Error(std::move(parts));
  }
  return {.format = found->id, .kind = kind};
}

FileFormat::Id format_to_write(const std::filesystem::path& file, Kinds kinds) {
  const FileFormat* const format = format_by_ending(file);
  const bool is_written = format != nullptr && format->trait != FileFormat::Trait::read_only;
  if (is_written && is_one_of(format->kind, kinds)) return format->id;
  throw Error({.file = file.string(),
               .expected = fmt::format("expected a file ending in {}, found '{}'", endings_written(kinds),
                                       visible_text(file.extension().string(), k_longest_quote))});
}

void check_overwriting(const std::filesystem::path& file, bool by_statistics) {
  const FileFormat* const format = by_statistics ? &file_formats().back() : format_by_ending(file);
  std::error_code ignored;
  if (format == nullptr || !std::filesystem::is_regular_file(file, ignored)) return;
  const FileStart start = start_of(file);
  if (start.file_size == 0 || format->is_it(start)) return;
  throw Error({.file = file.string(),
               .expected = fmt::format("already exists and is no {}", format->name),
               .remedy = "remove it, or choose another name"});
}

}  // namespace cloud2csg
