#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace cloud2csg {

enum class ScalarType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

[[nodiscard]] constexpr std::size_t size_of(ScalarType type) {
  constexpr std::array<std::size_t, 10> k_sizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return k_sizes[static_cast<std::size_t>(type)];
}

/// Reads a T at `bytes`, which need not be aligned, in the given byte order.
template <typename T>
[[nodiscard]] T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// One property of many records: `base` is its first byte, `stride` the bytes from one record to the next.
struct BinaryColumn {
  const char* base;
  std::size_t stride;
  ScalarType type;
  std::endian order;
};

/// Decodes the column's first out.size() numbers. Precondition: the bytes exist.
void decode_column(const BinaryColumn& column, std::span<double> out);

[[nodiscard]] inline double decode(const char* bytes, ScalarType type, std::endian order) {
  double value = 0.0;
  decode_column({bytes, 0, type, order}, {&value, 1});
  return value;
}

}  // namespace cloud2csg
