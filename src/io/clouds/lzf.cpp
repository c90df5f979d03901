#include "io/clouds/lzf.hpp"

#include <cstdint>

namespace cloud2csg {
namespace {

/// A control byte below this precedes that many literal bytes plus one. Any other announces a repetition.
constexpr std::size_t k_literal_limit = 32;
/// Three bytes of input give at most this much output.
constexpr std::size_t k_longest_repetition = 264;

}  // namespace

std::optional<std::string> decompress_lzf(std::string_view compressed, std::size_t size) {
  if (size / k_longest_repetition > compressed.size()) return std::nullopt;
  std::string out;
  out.reserve(size);
  std::size_t in = 0;
  const auto next_byte = [&] { return static_cast<std::size_t>(static_cast<std::uint8_t>(compressed[in++])); };
  while (in < compressed.size()) {
    const std::size_t control = next_byte();
    if (control < k_literal_limit) {
      const std::size_t length = control + 1;
      if (compressed.size() - in < length || size - out.size() < length) return std::nullopt;
      out.append(compressed.substr(in, length));
      in += length;
      continue;
    }
    std::size_t length = (control >> 5U) + 2;
    const bool long_form = length == 9;
    if (compressed.size() - in < (long_form ? 2U : 1U)) return std::nullopt;
    if (long_form) length += next_byte();
    const std::size_t distance = ((control & 31U) << 8U) + next_byte() + 1;
    if (distance > out.size() || size - out.size() < length) return std::nullopt;
    // Copies byte by byte, because a repetition may overlap its own output.
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - distance]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace cloud2csg
