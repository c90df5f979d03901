#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "io/clouds/file_content.hpp"

namespace cloud2csg {

struct ZipEntry {
  const char* name;
  std::string_view bytes;
};

/// The bytes of a zip archive, compressed and without a time: the same for the same entries. @throws Error
[[nodiscard]] std::string zip_archive(std::span<const ZipEntry> entries);

/// One entry of the archive that a file is. Nothing beyond `limit` bytes is unpacked.
/// @throws Error when the archive is damaged, has no such entry, or when that is larger
[[nodiscard]] std::string unzip_entry(const FileContent& file, const std::string& name, std::size_t limit);

}  // namespace cloud2csg
