#include "io/clouds/scalar_type.hpp"

namespace cloud2csg {
namespace {

template <typename T>
void decode_as(const BinaryColumn& column, std::span<double> out) {
  const char* cursor = column.base;
  for (double& value : out) {
    value = static_cast<double>(load<T>(cursor, column.order));
    cursor += column.stride;
  }
}

}  // namespace

void decode_column(const BinaryColumn& column, std::span<double> out) {
  switch (column.type) {
    case ScalarType::int8:
      return decode_as<std::int8_t>(column, out);
    case ScalarType::uint8:
      return decode_as<std::uint8_t>(column, out);
    case ScalarType::int16:
      return decode_as<std::int16_t>(column, out);
    case ScalarType::uint16:
      return decode_as<std::uint16_t>(column, out);
    case ScalarType::int32:
      return decode_as<std::int32_t>(column, out);
    case ScalarType::uint32:
      return decode_as<std::uint32_t>(column, out);
    case ScalarType::int64:
      return decode_as<std::int64_t>(column, out);
    case ScalarType::uint64:
      return decode_as<std::uint64_t>(column, out);
    case ScalarType::float32:
      return decode_as<float>(column, out);
    case ScalarType::float64:
      return decode_as<double>(column, out);
  }
}

}  // namespace cloud2csg
