#pragma once

#include <cstddef>
#include <optional>

namespace cloud2csg {

/// Growth of the resident set during the object's lifetime. Freed memory goes back first, so that its reuse counts.
class PeakMemory {
 public:
  PeakMemory();

  /// Absent where the system does not report the peak or cannot reset it.
  [[nodiscard]] std::optional<std::size_t> grown_bytes() const;

 private:
  bool is_reset_;
  std::optional<std::size_t> before_;
};

}  // namespace cloud2csg
