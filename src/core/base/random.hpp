#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace cloud2csg {

/// Step of splitmix64: 2^64 by the golden ratio.
constexpr std::uint64_t k_golden = 0x9e3779b97f4a7c15ULL;

/// What splitmix64 (Steele, Lea, Flood 2014) returns from state x: every input bit reaches every output bit.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) {
  x += k_golden;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31U);
}

/// Random numbers as a pure function of (seed, stage, item, step): xoshiro256** (Blackman, Vigna 2018) seeded by
/// splitmix64. The distributions are our own, because the standard library's differ between implementations.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t stage = 0, std::uint64_t item = 0, std::uint64_t step = 0) {
    std::uint64_t x = seed;
    for (const std::uint64_t key : {stage, item, step}) x = mix(mix(x) + key - k_golden);
    for (std::uint64_t& word : state_) {
      word = mix(x);
      x += k_golden;
    }
  }

  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }

  /// Uniform in 0 .. count - 1. Precondition: 0 < count < 2^32. Multiply-shift; its bias of 2^-32 matters nowhere.
  std::uint32_t below(std::size_t count) {
    return static_cast<std::uint32_t>(((next() >> 32U) * static_cast<std::uint64_t>(count)) >> 32U);
  }

  /// Standard normal, by Box and Muller; one value a call.
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace cloud2csg
