#pragma once

#include <filesystem>

namespace cloud2csg::app {

/// A file is overwritten by one of its kind only: another under its name is somebody's work. What is there is told by
/// how it begins, as far as files of the kind asked for have to begin alike; of texts no more is asked than that they
/// are text. A file that is not there, or is empty, may be written.
/// @throws Error where a file of another kind is there
void check_overwriting(const std::filesystem::path& file);

}  // namespace cloud2csg::app
