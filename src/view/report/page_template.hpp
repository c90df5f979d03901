#pragma once

#include <string_view>

namespace cloud2csg {

/// The page of viewer/, built: one HTML file with a mark where the data goes. Empty when it was not built.
[[nodiscard]] std::string_view page_template();

}  // namespace cloud2csg
