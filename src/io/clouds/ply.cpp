#include "io/clouds/ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "io/clouds/text_rows.hpp"

namespace cloud2csg {
namespace {

constexpr std::array<std::pair<std::string_view, ScalarType>, 16> k_type_names{{
    {"char", ScalarType::int8},
    {"int8", ScalarType::int8},
    {"uchar", ScalarType::uint8},
    {"uint8", ScalarType::uint8},
    {"short", ScalarType::int16},
    {"int16", ScalarType::int16},
    {"ushort", ScalarType::uint16},
    {"uint16", ScalarType::uint16},
    {"int", ScalarType::int32},
    {"int32", ScalarType::int32},
    {"uint", ScalarType::uint32},
    {"uint32", ScalarType::uint32},
    {"float", ScalarType::float32},
    {"float32", ScalarType::float32},
    {"double", ScalarType::float64},
    {"float64", ScalarType::float64},
}};

/// Parses a header line by line and keeps the line number for messages.
class PlyHeaderParser {
 public:
  explicit PlyHeaderParser(const FileContent& content) : content_(content) {}

  PlyHeader parse() {
    if (next_words() != std::vector<std::string>{"ply"}) fail(R"(expected "ply" as the first line)");
    const PlyFormat format = parse_format();
    while (true) {
      const std::vector<std::string> words = next_words();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "element") {
        add_element(words);
      } else if (words[0] == "property") {
        add_property(words);
      } else {
        fail("expected element, property, comment or end_header");
      }
    }
    return {.format = format, .elements = std::move(elements_), .data_offset = offset_, .line_count = line_};
  }

 private:
  [[noreturn]] void fail(std::string expected) const {
    content_.fail({FilePosition::Unit::line, line_}, std::move(expected), "is it a .ply file?");
  }

  std::vector<std::string> next_words() {
    ++line_;
    const std::string_view rest = content_.bytes().substr(offset_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) fail("the header has no end_header");
    offset_ += end + 1;
    return split_words(rest.substr(0, end));
  }

  PlyFormat parse_format() {
    std::vector<std::string> words = next_words();
    while (words.empty() || words[0] == "comment" || words[0] == "obj_info") words = next_words();
    if (words.size() == 3 && words[0] == "format" && words[2] == "1.0") {
      if (words[1] == "ascii") return PlyFormat::ascii;
      if (words[1] == "binary_little_endian") return PlyFormat::binary_little_endian;
      if (words[1] == "binary_big_endian") return PlyFormat::binary_big_endian;
    }
    fail(R"(expected "format", then "ascii 1.0", "binary_little_endian 1.0" or "binary_big_endian 1.0")");
  }

  void add_element(const std::vector<std::string>& words) {
    const std::optional<std::size_t> count = words.size() == 3 ? parse_count(words[2]) : std::nullopt;
    if (!count) fail(R"(expected "element <name> <count>")");
    elements_.push_back({.name = words[1], .count = *count, .header_line = line_});
  }

  void add_property(const std::vector<std::string>& words) {
    if (elements_.empty()) fail("expected an element before its properties");
    std::vector<PlyProperty>& properties = elements_.back().properties;
    if (words.size() == 3) {
      properties.push_back({.name = words[2], .type = parse_type(words[1])});
    } else if (words.size() == 5 && words[1] == "list") {
      properties.push_back({.name = words[4], .type = parse_type(words[3]), .list_count = parse_type(words[2])});
    } else {
      fail(R"(expected "property <type> <name>" or "property list <type> <type> <name>")");
    }
  }

  [[nodiscard]] ScalarType parse_type(std::string_view word) const {
    for (const auto& [name, type] : k_type_names) {
      if (name == word) return type;
    }
    fail("expected a type such as float, double, uchar or int");
  }

  const FileContent& content_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
  std::vector<PlyElement> elements_;
};

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.list_count.has_value(); });
}

std::size_t PlyElement::stride() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) bytes += size_of(property.type);
  return bytes;
}

PlyHeader parse_ply_header(const FileContent& content) {
  return PlyHeaderParser(content).parse();
}

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
    // Exceeding the row's length marks the row as wrong.
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
