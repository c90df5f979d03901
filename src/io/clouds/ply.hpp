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

/// Walks over the records of a .ply file one by one, of text or binary, in the order of the header.
class PlyRecords {
 public:
  PlyRecords(const FileContent& content, const PlyHeader& header);

  /// Steps to the next record. False when the file ends before its end.
  /// @throws Error for a line of text that does not have what the element wants.
  [[nodiscard]] bool next(const PlyElement& element);
  /// Steps over all records of an element. @returns how many there are, at most element.count.
  std::size_t skip(const PlyElement& element);

  /// A property of the record that was stepped to: the number, or those of a list. Valid until the next step.
  [[nodiscard]] double number(std::size_t property) const { return numbers_[starts_[property]]; }
  [[nodiscard]] std::span<const double> list(std::size_t property) const;

  /// The record that was stepped to.
  [[nodiscard]] FilePosition where() const;
  /// The first byte after it in a binary file.
  [[nodiscard]] std::size_t offset() const { return offset_; }

 private:
  [[nodiscard]] bool next_line(const PlyElement& element);
  [[nodiscard]] bool next_bytes(const PlyElement& element);
  /// Appends `count` numbers of the type to the record's. False when the file ends before.
  [[nodiscard]] bool take(ScalarType type, std::size_t count);

  const FileContent& content_;
  TextRows rows_;
  bool is_text_;
  std::endian order_;
  std::size_t offset_;
  std::size_t record_offset_;
  std::vector<double> numbers_ = {};      ///< of the record: its properties, a list's length before its numbers
  std::vector<std::size_t> starts_ = {};  ///< of each property among these
};

}  // namespace cloud2csg
