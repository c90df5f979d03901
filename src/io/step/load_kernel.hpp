#pragma once

#include <filesystem>
#include <string>

#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

struct Kernel {
  KernelRun run = nullptr;          ///< null if there is none
  std::string missing = {};         ///< why there is none
  std::string remedy = {};          ///< how to get one
  bool lacks_opencascade = false;   ///< the module exists, but lacks some of its libraries
  std::filesystem::path file = {};  ///< where it was found
};

/// Loads the module once a process and keeps it. Looks beside the installed program's libraries (its run path), then in
/// the system's folders, then in LD_LIBRARY_PATH.
[[nodiscard]] const Kernel& load_kernel();

[[nodiscard]] bool is_kernel_built_in();

}  // namespace cloud2csg::brep
