#pragma once

#include <bit>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/clouds/file_content.hpp"
#include "io/clouds/scalar_type.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {

struct PlyProperty {
  std::string name;
  ScalarType type;
  /// For a list: the type of its leading entry count.
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
  std::size_t data_offset;
  std::size_t line_count;
};

/// @throws Error naming the line.
[[nodiscard]] PlyHeader parse_ply_header(const FileContent& content);

/// Reads the records of a text or binary .ply file one by one, in the order of the header.
class PlyRecords {
 public:
  PlyRecords(const FileContent& content, const PlyHeader& header);

  /// Moves to the next record; false if the file ends first. @throws Error for a line that does not fit the element.
  [[nodiscard]] bool next(const PlyElement& element);
  /// Skips all records of an element. @returns the number of records found, at most element.count.
  std::size_t skip(const PlyElement& element);

  /// A property of the current record: its number, or the numbers of a list. Valid until the next step.
  [[nodiscard]] double number(std::size_t property) const { return numbers_[starts_[property]]; }
  [[nodiscard]] std::span<const double> list(std::size_t property) const;

  [[nodiscard]] FilePosition where() const;
  /// The first byte after the current record in a binary file.
  [[nodiscard]] std::size_t offset() const { return offset_; }

 private:
  [[nodiscard]] bool next_line(const PlyElement& element);
  [[nodiscard]] bool next_bytes(const PlyElement& element);
  /// Appends `count` numbers of a type to the record. False when the file ends first.
  [[nodiscard]] bool take(ScalarType type, std::size_t count);

  const FileContent& content_;
  TextRows rows_;
  bool is_text_;
  std::endian order_;
  std::size_t offset_;
  std::size_t record_offset_;
  std::vector<double> numbers_ = {};      ///< a list's length precedes its numbers
  std::vector<std::size_t> starts_ = {};  ///< start of each property in `numbers_`
};

}  // namespace cloud2csg
