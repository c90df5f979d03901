#include "core/base/scratch_file.hpp"

#include <system_error>

namespace cloud2csg {

ScratchFile::ScratchFile(std::string_view ending) {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error) / "cloud2csg";
  if (error) refuse_output("the folder for temporary files", "is missing", error.value());
  try {
    file_.emplace(place, ending);
  } catch (const std::system_error& failure) {
    refuse_output(place, "cannot be written", failure.code().value());
  }
}

}  // namespace cloud2csg
