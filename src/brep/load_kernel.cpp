#include "brep/load_kernel.hpp"

#include <fmt/format.h>

#ifdef CLOUD2CSG_KERNEL_MODULE
#include <dlfcn.h>
#endif

namespace cloud2csg::brep {
namespace {

Kernel find_kernel() {
#ifdef CLOUD2CSG_KERNEL_MODULE
  constexpr const char* k_reinstall = "install cloud2csg anew, or name the module's folder in LD_LIBRARY_PATH";
  void* const module = ::dlopen(CLOUD2CSG_KERNEL_MODULE, RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    const char* const reason = ::dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread
    return {.missing = fmt::format("its module for OpenCASCADE cannot be loaded ({})", reason != nullptr ? reason : ""),
            .remedy = k_reinstall};
  }
  // The one way to get a function out of a module.
  const auto version = reinterpret_cast<KernelVersion>(::dlsym(module, k_kernel_version_symbol));
  const auto run = reinterpret_cast<KernelRun>(::dlsym(module, k_kernel_run_symbol));
  if (version == nullptr || run == nullptr || version() != k_kernel_version) {
    return {.missing = "its module " CLOUD2CSG_KERNEL_MODULE " is of another version", .remedy = k_reinstall};
  }
  return {.run = run};
#else
  return {.missing = "it was built without OpenCASCADE",
          .remedy = "install libocct-data-exchange-dev and build it anew"};
#endif
}

}  // namespace

const Kernel& load_kernel() {
  static const Kernel kernel = find_kernel();
  return kernel;
}

}  // namespace cloud2csg::brep
