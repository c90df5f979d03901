#pragma once

#include <string>

#include "cloud2csg/view.hpp"

namespace cloud2csg {

/// The page's data as the bytes of a Payload. Precondition: the model has a tree; valid options. @throws Cancelled
[[nodiscard]] std::string gather_payload(const Report& report, const ReportOptions& options, const RunContext& run);

}  // namespace cloud2csg
