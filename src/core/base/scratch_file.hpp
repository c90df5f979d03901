#pragma once

#include <filesystem>
#include <optional>

#include "core/base/temporary_file.hpp"

namespace cloud2csg {

/// A file in the system's folder for temporary files, as long as this lives.
class ScratchFile {
 public:
  /// @throws Error
  ScratchFile();
  [[nodiscard]] const std::filesystem::path& path() const { return file_->path(); }

 private:
  std::optional<TemporaryFile> file_ = {};
};

}  // namespace cloud2csg
