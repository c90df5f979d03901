#include "io/step/load_kernel.hpp"

#include <fmt/format.h>

#ifdef CLOUD2CSG_KERNEL_MODULE
#include <dlfcn.h>

#include <system_error>
#endif

namespace cloud2csg::brep {
namespace {

#ifdef CLOUD2CSG_KERNEL_MODULE
constexpr const char* k_reinstall = "install cloud2csg again, or add the module's folder to LD_LIBRARY_PATH";

std::filesystem::path file_of(const void* symbol) {
  Dl_info info{};
  std::error_code ignored;
  if (::dladdr(symbol, &info) == 0) return {};
  return std::filesystem::weakly_canonical(info.dli_fname, ignored);
}
#endif

Kernel find_kernel() {
#ifdef CLOUD2CSG_KERNEL_MODULE
  void* const module = ::dlopen(CLOUD2CSG_KERNEL_MODULE, RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    const char* const error = ::dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread
    const std::string reason = error != nullptr ? error : "";
    // The message begins with the file that was not found: the module or one of its dependencies.
    const bool lacks_opencascade = reason.starts_with("libTK");
    return {.missing = fmt::format("its module for OpenCASCADE cannot be loaded ({})", reason),
            .remedy = lacks_opencascade ? "install OpenCASCADE (on Debian libocct-data-exchange-7.6)" : k_reinstall,
            .lacks_opencascade = lacks_opencascade};
  }
  // dlsym() requires the cast.
  const auto version = reinterpret_cast<KernelVersion>(::dlsym(module, k_kernel_version_symbol));
  const auto run = reinterpret_cast<KernelRun>(::dlsym(module, k_kernel_run_symbol));
  if (version == nullptr || run == nullptr || version() != k_kernel_version) {
    return {.missing = "its module " CLOUD2CSG_KERNEL_MODULE " is of another version", .remedy = k_reinstall};
  }
  return {.run = run, .file = file_of(reinterpret_cast<const void*>(run))};
#else
  return {.missing = "it was built without OpenCASCADE",
          .remedy = "install libocct-data-exchange-dev and build cloud2csg again"};
#endif
}

}  // namespace

bool is_kernel_built_in() {
#ifdef CLOUD2CSG_KERNEL_MODULE
  return true;
#else
  return false;
#endif
}

const Kernel& load_kernel() {
  static const Kernel kernel = find_kernel();
  return kernel;
}

}  // namespace cloud2csg::brep
