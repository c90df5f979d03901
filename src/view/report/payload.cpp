#include "view/report/payload.hpp"

#include <zlib.h>

#include <array>
#include <cassert>
#include <new>
#include <stdexcept>
#include <type_traits>

namespace cloud2csg {
namespace {

/// Maps 0, -1, 1, -2, 2... to 0, 1, 2, 3, 4...
template <class Number>
Number zigzag(Number difference) {
  using Signed = std::make_signed_t<Number>;
  constexpr int k_sign_bit = 8 * sizeof(Number) - 1;
  const auto value = static_cast<Signed>(difference);
  return static_cast<Number>(static_cast<Number>(difference << 1U) ^ static_cast<Number>(value >> k_sign_bit));
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8U) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? k_digits[(group >> (6U * (3U - static_cast<unsigned>(k)))) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace

template <class Number>
Payload::Json Payload::add(std::span<const Number> values, std::size_t columns, bool as_differences) {
  assert(columns > 0 && values.size() % columns == 0);
  const std::size_t at = sections_.size();
  const std::size_t rows = values.size() / columns;
  sections_.reserve(at + values.size_bytes());
  for (unsigned byte = 0; byte < sizeof(Number); ++byte) {
    for (std::size_t column = 0; column < columns; ++column) {
      Number previous = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const Number value = values[row * columns + column];
        const auto stored = as_differences ? zigzag(static_cast<Number>(value - previous)) : value;
        sections_ += static_cast<char>((stored >> (8U * byte)) & 0xFFU);
        previous = value;
      }
    }
  }
  return {{"at", at},
          {"bytes", sections_.size() - at},
          {"width", sizeof(Number)},
          {"columns", columns},
          {"differences", as_differences}};
}

Payload::Json Payload::add_differences(std::span<const std::uint16_t> values, std::size_t columns) {
  return add(values, columns, true);
}
Payload::Json Payload::add_differences(std::span<const std::uint32_t> values, std::size_t columns) {
  return add(values, columns, true);
}
Payload::Json Payload::add_plain(std::span<const std::uint16_t> values, std::size_t columns) {
  return add(values, columns, false);
}

Payload::Json Payload::add_bytes(std::string_view bytes) {
  const std::size_t at = sections_.size();
  sections_ += bytes;
  return {{"at", at}, {"bytes", bytes.size()}, {"width", 1}, {"columns", 1}, {"differences", false}};
}

std::string Payload::bytes(const Json& text) const {
  // Ids and names may not be UTF-8: invalid bytes become the replacement character.
  const std::string json = text.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string all;
  all.reserve(4 + json.size() + sections_.size());
  for (unsigned byte = 0; byte < 4; ++byte) all += static_cast<char>((json.size() >> (8U * byte)) & 0xFFU);
  all += json;
  all += sections_;
  return all;
}

std::string compressed_base64(std::string_view bytes) {
  constexpr int k_level = 9;
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string compressed(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), k_level);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK) throw std::runtime_error("zlib cannot compress");  // impossible for any input
  compressed.resize(size);
  return base64(compressed);
}

}  // namespace cloud2csg
