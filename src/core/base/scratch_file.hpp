#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/temporary_file.hpp"

namespace cloud2csg {

/// A file in the system's folder for temporary files, as long as this lives.
class ScratchFile {
 public:
  /// Its name has that ending. @throws Error
  explicit ScratchFile(std::string_view ending = {});
  [[nodiscard]] const std::filesystem::path& path() const { return file_->path(); }

 private:
  std::optional<TemporaryFile> file_ = {};
};

}  // namespace cloud2csg
