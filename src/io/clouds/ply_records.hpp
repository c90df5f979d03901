#pragma once

#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "io/clouds/ply_header.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {

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
