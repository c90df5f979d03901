#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace cloud2csg {

/// Decompresses LZF (Lehmann), as in .pcd with DATA binary_compressed; absent if damaged or not `size` bytes. O(size)
[[nodiscard]] std::optional<std::string> decompress_lzf(std::string_view compressed, std::size_t size);

}  // namespace cloud2csg
