#pragma once

#include <zlib.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// Reads back what a report holds, as its page does.
namespace cloud2csg::test {

struct Decoded {
  nlohmann::json text;
  std::string sections;

  template <class Number>
  [[nodiscard]] std::vector<Number> numbers(const nlohmann::json& section) const {
    const auto at = section["at"].get<std::size_t>();
    const auto columns = section["columns"].get<std::size_t>();
    const std::size_t count = section["bytes"].get<std::size_t>() / sizeof(Number);
    const std::size_t rows = count / columns;
    std::vector<Number> values(count);
    for (std::size_t column = 0; column < columns; ++column) {
      Number previous = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        std::uint64_t stored = 0;
        for (std::size_t byte = 0; byte < sizeof(Number); ++byte) {
          const auto value = static_cast<unsigned char>(sections.at(at + byte * count + column * rows + row));
          stored |= static_cast<std::uint64_t>(value) << (8 * byte);
        }
        if (section["differences"].get<bool>()) {
          const std::uint64_t difference = (stored >> 1U) ^ (~(stored & 1U) + 1U);
          stored = previous + difference;
        }
        previous = static_cast<Number>(stored);
        values[row * columns + column] = previous;
      }
    }
    return values;
  }
};

inline Decoded decoded(std::string_view payload) {
  std::size_t size = 0;
  for (std::size_t byte = 0; byte < 4; ++byte) {
    size |= static_cast<std::size_t>(static_cast<unsigned char>(payload.at(byte))) << (8 * byte);
  }
  return {.text = nlohmann::json::parse(payload.substr(4, size)), .sections = std::string(payload.substr(4 + size))};
}

inline std::string from_base64(std::string_view text) {
  constexpr std::string_view k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = k_digits.find(c);
    if (digit == std::string_view::npos) throw std::runtime_error("not base64");
    group = (group << 6U) | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>((group >> static_cast<unsigned>(bits)) & 0xFFU);
  }
  return bytes;
}

inline std::string inflated(const std::string& compressed) {
  std::string bytes(64 * 1024, '\0');
  for (;;) {
    uLongf size = bytes.size();
    const int status =
        uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(compressed.data()),
                   static_cast<uLong>(compressed.size()));
    if (status == Z_OK) return bytes.substr(0, size);
    if (status != Z_BUF_ERROR || bytes.size() > (std::size_t{1} << 30U)) throw std::runtime_error("not zlib");
    bytes.resize(2 * bytes.size());
  }
}

/// The data between the tags, nothing else.
inline std::string data_of_page(std::string_view page) {
  constexpr std::string_view k_begin = R"(id="report">)";
  const std::size_t begin = page.find(k_begin);
  if (begin == std::string_view::npos) throw std::runtime_error("the page has no data");
  const std::size_t end = page.find('<', begin);
  return std::string(page.substr(begin + k_begin.size(), end - begin - k_begin.size()));
}

}  // namespace cloud2csg::test
