#include "bench/experiment/peak_memory.hpp"

#include <malloc.h>

#include <charconv>
#include <fstream>
#include <string>
#include <string_view>

namespace cloud2csg {
namespace {

/// A field of /proc/self/status; its unit is KiB.
std::optional<std::size_t> status_bytes(std::string_view field) {
  constexpr std::size_t k_kibibyte = 1024;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with(field)) continue;
    const std::size_t digit = line.find_first_of("0123456789");
    std::size_t number = 0;
    if (digit == std::string::npos) return std::nullopt;
    std::from_chars(line.data() + digit, line.data() + line.size(), number);
    return number * k_kibibyte;
  }
  return std::nullopt;
}

/// Resets the peak resident set to the present one; see proc(5).
bool reset_highest() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

}  // namespace

PeakMemory::PeakMemory() {
  ::malloc_trim(0);
  is_reset_ = reset_highest();
  before_ = status_bytes("VmRSS:");
}

std::optional<std::size_t> PeakMemory::grown_bytes() const {
  const std::optional<std::size_t> highest = status_bytes("VmHWM:");
  if (!is_reset_ || !before_ || !highest) return std::nullopt;
  return *highest > *before_ ? *highest - *before_ : 0;
}

}  // namespace cloud2csg
