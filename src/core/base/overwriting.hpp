#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace cloud2csg {

/// Begins, as a comment, each file that people might as well have written by hand: scripts and graphs. Only with it
/// are they overwritten.
inline constexpr std::string_view k_program_mark = "Written by cloud2csg";

/// What a file is to hold, where its ending leaves that open.
enum class Content : std::uint8_t { by_ending, statistics };

/// A file is overwritten by one of its kind only: another under its name is somebody's work. What is there is told by
/// how it begins: a mesh, a cloud, a picture or a solid is of its kind whoever wrote it, a model, statistics, a script
/// or a page when cloud2csg did. A file that is not there, is empty or is no regular file may be written.
/// @throws Error where a file of another kind is there
void check_overwriting(const std::filesystem::path& file, Content content = Content::by_ending);

}  // namespace cloud2csg
