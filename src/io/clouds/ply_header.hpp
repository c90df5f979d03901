#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/clouds/file_content.hpp"
#include "io/clouds/scalar_type.hpp"

namespace cloud2csg {

struct PlyProperty {
  std::string name;
  ScalarType type;
  /// For a list: the type of the number of entries that precedes them.
  std::optional<ScalarType> list_count = {};
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::size_t header_line;
  std::vector<PlyProperty> properties = {};

  [[nodiscard]] bool has_lists() const;
  /// Bytes of a record. Precondition: no lists.
  [[nodiscard]] std::size_t stride() const;
};

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;  ///< in the order of the data
  std::size_t data_offset;           ///< first byte after the header
  std::size_t line_count;            ///< lines of the header
};

/// @throws Error naming the line.
[[nodiscard]] PlyHeader parse_ply_header(const FileContent& content);

}  // namespace cloud2csg
