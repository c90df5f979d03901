#pragma once

#include <filesystem>
#include <string>

#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// The module with OpenCASCADE.
struct Kernel {
  KernelRun run = nullptr;          ///< absent when there is none
  std::string missing = {};         ///< then, why
  std::string remedy = {};          ///< and what to do about it
  bool lacks_opencascade = false;   ///< the module is there, libraries that it needs are not
  std::filesystem::path file = {};  ///< where it was found
};

/// Loads it, once a process; it stays. Looked for where the program looks for its libraries: beside the installed
/// program's (its run path), then where the system's are, then in LD_LIBRARY_PATH.
[[nodiscard]] const Kernel& load_kernel();

/// Whether there is a module to be loaded.
[[nodiscard]] bool is_kernel_built_in();

}  // namespace cloud2csg::brep
