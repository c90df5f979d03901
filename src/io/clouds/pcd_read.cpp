#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/file_content.hpp"
#include "io/clouds/formats.hpp"
#include "io/clouds/lzf.hpp"
#include "io/clouds/scalar_type.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {
namespace {

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
  std::size_t data_offset;
  std::size_t line_count;
  std::size_t fields_line;
  std::optional<Eigen::Vector3d> sensor_position = {};  ///< common to all points; absent if VIEWPOINT does not tell

  [[nodiscard]] std::size_t stride() const;
  [[nodiscard]] std::size_t columns() const;  ///< numbers of a point
};

/// Far above any real file; prevents overflow in products of header numbers.
constexpr std::size_t k_most_columns = 1'000'000;
constexpr std::size_t k_most_points = std::size_t{1} << 40;

std::optional<ScalarType> scalar_type(std::string_view type, std::string_view size) {
  if (type == "F") {
    if (size == "4") return ScalarType::float32;
    if (size == "8") return ScalarType::float64;
  } else if (type == "I") {
    if (size == "1") return ScalarType::int8;
    if (size == "2") return ScalarType::int16;
    if (size == "4") return ScalarType::int32;
    if (size == "8") return ScalarType::int64;
  } else if (type == "U") {
    if (size == "1") return ScalarType::uint8;
    if (size == "2") return ScalarType::uint16;
    if (size == "4") return ScalarType::uint32;
    if (size == "8") return ScalarType::uint64;
  }
  return std::nullopt;
}

/// The words after a header keyword and their line number (0 = keyword missing).
struct Entry {
  std::vector<std::string> values = {};
  std::size_t line = 0;
};

class PcdHeaderParser {
 public:
  explicit PcdHeaderParser(const FileContent& content) : content_(content) {}

  PcdHeader parse() {
    while (data_.line == 0) parse_line();
    PcdHeader header{.fields = {},
                     .points = 0,
                     .data = data_kind(),
                     .data_offset = offset_,
                     .line_count = line_,
                     .fields_line = fields_.line,
                     .sensor_position = sensor_position()};
    header.fields = make_fields();
    header.points = point_count();
    return header;
  }

 private:
  [[noreturn]] void fail(std::size_t line, std::string expected) const {
    content_.fail({FilePosition::Unit::line, line}, std::move(expected), "is it a .pcd file?");
  }

  void parse_line() {
    ++line_;
    const std::string_view rest = content_.bytes().substr(offset_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) fail(line_, "the header has no DATA line");
    offset_ += end + 1;
    std::vector<std::string> words = split_words(rest.substr(0, end));
    if (words.empty() || words[0].starts_with('#') || words[0] == "VERSION") return;
    for (const auto& [keyword, entry] : entries()) {
      if (words[0] != keyword) continue;
      if (words.size() < 2) fail(line_, fmt::format("expected values after {}", keyword));
      words.erase(words.begin());
      *entry = {.values = std::move(words), .line = line_};
      return;
    }
    fail(line_, "expected VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA");
  }

  [[nodiscard]] std::vector<std::pair<std::string_view, Entry*>> entries() {
    return {{"FIELDS", &fields_}, {"SIZE", &size_},           {"TYPE", &type_},
            {"COUNT", &count_},   {"WIDTH", &width_},         {"HEIGHT", &height_},
            {"POINTS", &points_}, {"VIEWPOINT", &viewpoint_}, {"DATA", &data_}};
  }

  /// Programs that do not know the sensor position write 0 0 0 1 0 0 0.
  [[nodiscard]] std::optional<Eigen::Vector3d> sensor_position() const {
    if (viewpoint_.line == 0) return std::nullopt;
    constexpr std::array<double, 7> k_unknown{0, 0, 0, 1, 0, 0, 0};
    std::array<double, 7> numbers{};
    bool is_good = viewpoint_.values.size() == numbers.size();
    for (std::size_t i = 0; is_good && i < numbers.size(); ++i) {
      const std::optional<double> number = parse_number(viewpoint_.values[i]);
      is_good = number.has_value();
      numbers[i] = number.value_or(0.0);
    }
    if (!is_good) fail(viewpoint_.line, "expected VIEWPOINT with a position and a quaternion: 7 finite numbers");
    if (numbers == k_unknown) return std::nullopt;
    return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  }

  [[nodiscard]] PcdData data_kind() const {
    const std::string& kind = data_.values[0];
    if (kind == "ascii") return PcdData::ascii;
    if (kind == "binary") return PcdData::binary;
    if (kind == "binary_compressed") return PcdData::binary_compressed;
    fail(data_.line, "expected DATA ascii, binary or binary_compressed");
  }

  [[nodiscard]] std::vector<PcdField> make_fields() const {
    if (fields_.line == 0) fail(line_, "the header has no FIELDS line");
    const std::size_t field_count = fields_.values.size();
    for (const Entry* entry : {&size_, &type_, &count_}) {
      const bool may_be_absent = entry == &count_ && entry->line == 0;
      if (!may_be_absent && entry->values.size() != field_count) {
        fail(entry->line == 0 ? line_ : entry->line,
             fmt::format("expected a SIZE, a TYPE and a COUNT for each of the {} fields", field_count));
      }
    }
    std::vector<PcdField> fields;
    std::size_t columns = 0;
    for (std::size_t i = 0; i < field_count; ++i) {
      const std::optional<ScalarType> type = scalar_type(type_.values[i], size_.values[i]);
      if (!type) fail(type_.line, "expected TYPE F with SIZE 4 or 8, or I or U with SIZE 1, 2, 4 or 8");
      const std::optional<std::size_t> count = count_.line == 0 ? 1 : parse_count(count_.values[i]);
      if (!count || *count > k_most_columns || (columns += *count) > k_most_columns) {
        fail(count_.line, "expected COUNT to be small whole numbers");
      }
      fields.push_back({.name = fields_.values[i], .type = *type, .count = *count});
    }
    return fields;
  }

  [[nodiscard]] std::size_t number_in(const Entry& entry, const char* keyword) const {
    const std::optional<std::size_t> number = entry.line == 0 ? std::nullopt : parse_count(entry.values[0]);
    if (!number || *number > k_most_points) {
      fail(entry.line == 0 ? line_ : entry.line, fmt::format("expected {} with a number of points", keyword));
    }
    return *number;
  }

  [[nodiscard]] std::size_t point_count() const {
    if (points_.line == 0) {
      const std::size_t width = number_in(width_, "WIDTH");
      const std::size_t height = number_in(height_, "HEIGHT");
      if (height > 0 && width > k_most_points / height) fail(width_.line, "WIDTH times HEIGHT is too large");
      return width * height;
    }
    const std::size_t points = number_in(points_, "POINTS");
    if (width_.line != 0 && height_.line != 0) {
      const std::size_t width = number_in(width_, "WIDTH");
      const std::size_t height = number_in(height_, "HEIGHT");
      const bool agrees = height == 0 ? points == 0 : points % height == 0 && points / height == width;
      if (!agrees) fail(points_.line, fmt::format("expected POINTS to be WIDTH times HEIGHT, found {}", points));
    }
    return points;
  }

  const FileContent& content_;
  std::size_t offset_ = 0;
  std::size_t line_ = 0;
  Entry fields_, size_, type_, count_, width_, height_, points_, viewpoint_, data_;
};

std::size_t PcdHeader::stride() const {
  std::size_t bytes = 0;
  for (const PcdField& field : fields) bytes += field.bytes();
  return bytes;
}

std::size_t PcdHeader::columns() const {
  std::size_t numbers = 0;
  for (const PcdField& field : fields) numbers += field.count;
  return numbers;
}

PcdHeader parse_pcd_header(const FileContent& content) {
  return PcdHeaderParser(content).parse();
}

PointLayout find_fields(const FileContent& content, const PcdHeader& header) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) {
    names.push_back(field.count == 1 ? field.name : std::string());  // a coordinate is one number
  }
  return find_layout(content, {FilePosition::Unit::line, header.fields_line}, names);
}

/// Converts a layout from field indices to text columns.
PointLayout columns_of(const PcdHeader& header, const PointLayout& layout) {
  std::vector<std::size_t> first_column;
  std::size_t column = 0;
  for (const PcdField& field : header.fields) {
    first_column.push_back(column);
    column += field.count;
  }
  return layout.map([&](const std::array<std::size_t, 3>& fields) {
    return std::array{first_column[fields[0]], first_column[fields[1]], first_column[fields[2]]};
  });
}

Eigen::Vector3d pick(std::span<const double> row, const std::array<std::size_t, 3>& columns) {
  return {row[columns[0]], row[columns[1]], row[columns[2]]};
}

PointCloud read_ascii(const FileContent& content, const PcdHeader& header, const PointLayout& fields,
                      InvalidPoints invalid, const RunContext& run) {
  const PointLayout layout = columns_of(header, fields);
  TextRows rows(content, header.data_offset, header.line_count);
  CloudAssembly assembly(content, header.points, std::min(header.points, rows.bytes_left() / 6 + 1), invalid, run);
  while (const std::optional<std::span<const double>> row = rows.next_row()) {
    if (row->size() != header.columns()) {
      content.fail(rows.where(),
                   fmt::format("expected {} columns as the header announces, found {}", header.columns(), row->size()));
    }
    if (assembly.size() == header.points) {
      content.fail(rows.where(), fmt::format("expected no more than the announced {} points", header.points));
    }
    assembly.add(layout.map([&](const auto& columns) { return pick(*row, columns); }), rows.where());
  }
  if (assembly.size() < header.points) content.fail_truncated(rows.where(), header.points, assembly.size());
  return std::move(assembly).finish();
}

/// The columns of the fields: interleaved in records or, in compressed files, one whole field after another.
CloudColumns columns_at(const PcdHeader& header, const PointLayout& layout, const char* data, bool field_after_field) {
  std::vector<BinaryColumn> columns;
  const std::size_t stride = header.stride();
  for (const PcdField& field : header.fields) {
    columns.push_back({.base = data,
                       .stride = field_after_field ? field.bytes() : stride,
                       .type = field.type,
                       .order = std::endian::little});
    data += field_after_field ? field.bytes() * header.points : field.bytes();
  }
  return layout.map([&](const std::array<std::size_t, 3>& fields) {
    return std::array{columns[fields[0]], columns[fields[1]], columns[fields[2]]};
  });
}

PointCloud read_binary(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                       InvalidPoints invalid, const RunContext& run) {
  const std::size_t stride = header.stride();
  const std::size_t found = (content.bytes().size() - header.data_offset) / stride;
  if (found < header.points) {
    content.fail_truncated({FilePosition::Unit::byte, header.data_offset + found * stride}, header.points, found);
  }
  const char* const data = content.bytes().data() + header.data_offset;
  return cloud_of_columns(
      content, columns_at(header, layout, data, false), header.points,
      [&](std::size_t i) { return header.data_offset + i * stride; }, invalid, run);
}

PointCloud read_compressed(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                           InvalidPoints invalid, const RunContext& run) {
  const FilePosition where{FilePosition::Unit::byte, header.data_offset};
  constexpr std::size_t k_size_bytes = 2 * sizeof(std::uint32_t);
  const std::string_view data = content.bytes().substr(header.data_offset);
  if (data.size() < k_size_bytes) content.fail_truncated(where, header.points, 0);
  const std::size_t compressed_size = load<std::uint32_t>(data.data(), std::endian::little);
  const std::size_t size = load<std::uint32_t>(data.data() + sizeof(std::uint32_t), std::endian::little);
  if (size != header.points * header.stride()) {
    content.fail(where, fmt::format("expected {} bytes of data for the announced {} points, found {}",
                                    header.points * header.stride(), header.points, size));
  }
  if (data.size() - k_size_bytes < compressed_size) {
    content.fail(where,
                 fmt::format("the file announces {} points in {} compressed bytes but ends after {} bytes",
                             header.points, compressed_size, data.size() - k_size_bytes),
                 k_copy_again);
  }
  const std::optional<std::string> records = decompress_lzf(data.substr(k_size_bytes, compressed_size), size);
  if (!records) content.fail(where, "the compressed data is damaged", k_copy_again);
  return cloud_of_columns(
      content, columns_at(header, layout, records->data(), true), header.points,
      [&](std::size_t) { return header.data_offset; }, invalid, run);
}

PointCloud read_data(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                     InvalidPoints invalid, const RunContext& run) {
  switch (header.data) {
    case PcdData::ascii:
      return read_ascii(content, header, layout, invalid, run);
    case PcdData::binary:
      return read_binary(content, header, layout, invalid, run);
    case PcdData::binary_compressed:
      break;
  }
  return read_compressed(content, header, layout, invalid, run);
}

}  // namespace

PointCloud read_pcd(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  const PcdHeader header = parse_pcd_header(content);
  PointCloud cloud = read_data(content, header, find_fields(content, header), invalid, run);
  if (header.sensor_position && !cloud.has_sensor_positions()) {
    cloud.sensor_positions.resize(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) cloud.sensor_positions.set(i, *header.sensor_position);
  }
  return cloud;
}

}  // namespace cloud2csg
