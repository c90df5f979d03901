#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace cloud2csg {

/// What the page is given: a JSON text and arrays of numbers that it refers to. As bytes: the length of the JSON text
/// as four bytes, little endian, the text, then the sections one after another.
class Payload {
 public:
  using Json = nlohmann::ordered_json;

  /// Numbers, `columns` to a row, as differences to the row above (zigzag, so that small ones are small): first all
  /// lowest bytes, column by column, then the next ones. This is what compresses well. Returns {"at", "bytes", "width",
  /// "columns"}, for the JSON text.
  [[nodiscard]] Json add_differences(std::span<const std::uint16_t> values, std::size_t columns);
  [[nodiscard]] Json add_differences(std::span<const std::uint32_t> values, std::size_t columns);
  /// The same without differences: for numbers that have nothing in common with the row above.
  [[nodiscard]] Json add_plain(std::span<const std::uint16_t> values, std::size_t columns);
  [[nodiscard]] Json add_bytes(std::string_view bytes);

  [[nodiscard]] std::string bytes(const Json& text) const;

 private:
  template <class Number>
  Json add(std::span<const Number> values, std::size_t columns, bool as_differences);

  std::string sections_;
};

/// zlib's format, then base64: safe within any HTML.
[[nodiscard]] std::string compressed_base64(std::string_view bytes);

}  // namespace cloud2csg
