#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/clouds/file_content.hpp"
#include "io/clouds/scalar_type.hpp"

namespace cloud2csg {

struct PcdField {
  std::string name;
  ScalarType type;
  std::size_t count;  ///< numbers of this field in each point

  [[nodiscard]] std::size_t bytes() const { return count * size_of(type); }
};

enum class PcdData { ascii, binary, binary_compressed };

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points;
  PcdData data;
  std::size_t data_offset;  ///< first byte after the header
  std::size_t line_count;   ///< lines of the header
  std::size_t fields_line;
  std::optional<Eigen::Vector3d> sensor_position = {};  ///< of all points; absent where VIEWPOINT says nothing

  [[nodiscard]] std::size_t stride() const;   ///< bytes of a point
  [[nodiscard]] std::size_t columns() const;  ///< numbers of a point
};

/// @throws Error naming the line.
[[nodiscard]] PcdHeader parse_pcd_header(const FileContent& content);

}  // namespace cloud2csg
