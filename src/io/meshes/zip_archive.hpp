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

/// The bytes of a compressed zip archive without a time stamp: equal entries give equal bytes. @throws Error
[[nodiscard]] std::string zip_archive(std::span<const ZipEntry> entries);

/// Unpacks one entry of a zip file. @throws Error for a damaged archive, a missing entry, or one of over `limit` bytes
[[nodiscard]] std::string unzip_entry(const FileContent& file, const std::string& name, std::size_t limit);

}  // namespace cloud2csg
