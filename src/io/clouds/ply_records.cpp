#include "io/clouds/ply_records.hpp"

#include <fmt/format.h>

namespace cloud2csg {

PlyRecords::PlyRecords(const FileContent& content, const PlyHeader& header)
    : content_(content),
      rows_(content, header.data_offset, header.line_count),
      is_text_(header.format == PlyFormat::ascii),
      order_(header.format == PlyFormat::binary_little_endian ? std::endian::little : std::endian::big),
      offset_(header.data_offset),
      record_offset_(header.data_offset) {}

bool PlyRecords::next(const PlyElement& element) {
  return is_text_ ? next_line(element) : next_bytes(element);
}

bool PlyRecords::next_line(const PlyElement& element) {
  const std::optional<std::span<const double>> row = rows_.next_row();
  if (!row) return false;
  numbers_.assign(row->begin(), row->end());
  starts_.clear();
  std::size_t start = 0;
  for (const PlyProperty& property : element.properties) {
    starts_.push_back(start);
    const bool is_there = start < row->size();
    const std::optional<std::size_t> length =
        is_there && property.list_count ? whole_number((*row)[start], row->size()) : std::size_t{0};
    // One more than there are makes the row wrong.
    start += is_there && length ? 1 + *length : row->size() + 1;
  }
  if (start == row->size()) return true;
  content_.fail(rows_.where(), fmt::format("expected the {} properties that the header announces, found {} columns",
                                           element.properties.size(), row->size()));
}

bool PlyRecords::next_bytes(const PlyElement& element) {
  record_offset_ = offset_;
  numbers_.clear();
  starts_.clear();
  for (const PlyProperty& property : element.properties) {
    starts_.push_back(numbers_.size());
    std::size_t count = 1;
    if (property.list_count) {
      if (!take(*property.list_count, 1)) return false;
      const std::optional<std::size_t> length = whole_number(numbers_.back(), content_.bytes().size());
      if (!length) return false;
      count = *length;
    }
    if (!take(property.type, count)) return false;
  }
  return true;
}

bool PlyRecords::take(ScalarType type, std::size_t count) {
  const std::size_t bytes = size_of(type);
  if (count > (content_.bytes().size() - offset_) / bytes) return false;
  const std::size_t before = numbers_.size();
  numbers_.resize(before + count);
  decode_column({content_.bytes().data() + offset_, bytes, type, order_}, std::span(numbers_).subspan(before));
  offset_ += count * bytes;
  return true;
}

std::size_t PlyRecords::skip(const PlyElement& element) {
  if (element.properties.empty()) return element.count;
  std::size_t found = 0;
  while (found < element.count && (is_text_ ? rows_.next_line().has_value() : next_bytes(element))) ++found;
  return found;
}

std::span<const double> PlyRecords::list(std::size_t property) const {
  return std::span(numbers_).subspan(starts_[property] + 1, static_cast<std::size_t>(number(property)));
}

FilePosition PlyRecords::where() const {
  return is_text_ ? rows_.where() : FilePosition{FilePosition::Unit::byte, record_offset_};
}

}  // namespace cloud2csg
