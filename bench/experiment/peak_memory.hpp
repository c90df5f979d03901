#pragma once

#include <cstddef>
#include <optional>

namespace cloud2csg {

/// How far the process' memory grows while this lives: its resident set at the highest over that at the start.
/// What was freed before is given back to the system first, so that it counts again when it is used again.
class PeakMemory {
 public:
  PeakMemory();

  /// Absent where the system does not tell, or does not let the highest be reset.
  [[nodiscard]] std::optional<std::size_t> grown_bytes() const;

 private:
  bool is_reset_;
  std::optional<std::size_t> before_;
};

}  // namespace cloud2csg
