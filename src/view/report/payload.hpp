#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace cloud2csg {

/// The page's data: a JSON text and the arrays that it refers to. The bytes are the length of the JSON text (four
/// bytes, little endian), the text, then the sections one after another.
class Payload {
 public:
  using Json = nlohmann::ordered_json;

  /// Adds numbers, `columns` to a row, as zigzag differences to the row above: all lowest bytes column by column, then
  /// the next, which compresses well. Returns {"at", "bytes", "width", "columns"} for the JSON text.
  [[nodiscard]] Json add_differences(std::span<const std::uint16_t> values, std::size_t columns);
  [[nodiscard]] Json add_differences(std::span<const std::uint32_t> values, std::size_t columns);
  /// The same without differences, for numbers unrelated to the row above.
  [[nodiscard]] Json add_plain(std::span<const std::uint16_t> values, std::size_t columns);
  [[nodiscard]] Json add_bytes(std::string_view bytes);

  [[nodiscard]] std::string bytes(const Json& text) const;

 private:
  template <class Number>
  Json add(std::span<const Number> values, std::size_t columns, bool as_differences);

  std::string sections_;
};

/// zlib format in base64: safe in any HTML.
[[nodiscard]] std::string compressed_base64(std::string_view bytes);

}  // namespace cloud2csg
