#pragma once

#include <string_view>

namespace cloud2csg {

/// The built page of viewer/: an HTML file with a mark for the data. Empty when it was not built.
[[nodiscard]] std::string_view page_template();

}  // namespace cloud2csg
