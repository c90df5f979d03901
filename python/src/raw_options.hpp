#pragma once

#include <cstdint>
#include <optional>

#include "cloud.hpp"
#include "cloud2csg/reconstruct.hpp"

namespace cloud2csg::python {

/// Options with the cloud's exactness, and with `seed` in place of all their seeds.
[[nodiscard]] ReconstructOptions raw_options(const ReconstructOptions& options, const Cloud& cloud,
                                             std::optional<std::uint64_t> seed);

}  // namespace cloud2csg::python
