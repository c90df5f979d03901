#include "io/clouds/record_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_bytes_a_write = std::size_t{1} << 20;

template <typename T>
void append_binary(std::string& block, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  block.append(raw.data(), raw.size());
}

template <typename T>
void append_text(std::string& block, T value, char separator) {
  std::array<char, 32> digits;
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  block.append(digits.data(), end);
  block += separator;
}

template <typename T>
void append_record(std::string& block, std::span<const double> numbers, bool binary) {
  for (const double& number : numbers) {
    const T value = static_cast<T>(number);
    if (!std::isfinite(value)) {
      throw Error({.expected = fmt::format("a point cloud that can be written has finite numbers, found {}", number),
                   .remedy = sizeof(T) < sizeof(double) ? "write in double precision" : ""});
    }
    if (binary) {
      append_binary(block, value);
    } else {
      append_text(block, value, &number == &numbers.back() ? '\n' : ' ');
    }
  }
}

void append_colour(std::string& block, const Colour& colour, bool binary) {
  if (binary) {
    for (const std::uint8_t value : {colour.red, colour.green, colour.blue}) append_binary(block, value);
    return;
  }
  block.back() = ' ';  // instead of the end of the line
  block += fmt::format("{} {} {}\n", colour.red, colour.green, colour.blue);
}

}  // namespace

void write_records(AtomicFile& out, const PointCloud& cloud, const RecordFormat& format) {
  std::string block;
  std::array<double, 9> numbers{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    auto end = std::copy_n(cloud.positions[i].data(), 3, numbers.begin());
    if (format.normals) end = std::copy_n(cloud.normals[i].data(), 3, end);
    if (format.sensor_positions) end = std::copy_n(cloud.sensor_positions[i].data(), 3, end);
    const std::span<const double> used(numbers.begin(), end);
    if (format.double_precision) {
      append_record<double>(block, used, format.binary);
    } else {
      append_record<float>(block, used, format.binary);
    }
    if (!format.colours.empty()) append_colour(block, format.colours[i], format.binary);
    if (block.size() >= k_bytes_a_write) {
      out.write(block);
      block.clear();
    }
  }
  out.write(block);
}

}  // namespace cloud2csg
