#include "fuzz/mutate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

namespace cloud2csg::fuzz {
namespace {

constexpr std::array<std::string_view, 18> k_words{"-1",         "0",
                                                   "1",          "2",
                                                   "8",          "65536",
                                                   "2147483647", "4294967295",
                                                   "4294967296", "18446744073709551615",
                                                   "1e38",       "1e39",
                                                   "1e308",      "-1e999",
                                                   "nan",        "inf",
                                                   "0.5",        "99999999999999999999999999"};
constexpr std::array<std::uint32_t, 8> k_numbers{0,           1,           8,           0x7fff'ffff,
                                                 0x8000'0000, 0xffff'ffff, 0x7fc0'0000, 0x7f7f'ffff};

struct Part {
  std::size_t begin;
  std::size_t size;
};

Part some_part(const std::string& bytes, std::size_t longest, RandomStream& random) {
  const std::size_t begin = random.below(bytes.size());
  return {begin, 1 + random.below(std::min(longest, bytes.size() - begin))};
}

/// A number as text, the next one after some place; the place where there is none.
Part some_number(const std::string& bytes, RandomStream& random) {
  constexpr const char* k_characters = "+-.0123456789eE";
  const std::size_t begin = bytes.find_first_of("0123456789", random.below(bytes.size()));
  if (begin == std::string::npos) return some_part(bytes, 1, random);
  const std::size_t end = bytes.find_first_not_of(k_characters, begin);
  return {begin, std::min(end, bytes.size()) - begin};
}

void change(std::string& bytes, RandomStream& random) {
  const auto any_of = [&random](const auto& list) { return list[random.below(list.size())]; };
  switch (random.below(10)) {
    case 0:
      bytes[random.below(bytes.size())] ^= static_cast<char>(1U << random.below(8));
      break;
    case 1:
      bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
      break;
    case 2:
      bytes.resize(random.below(bytes.size()) + 1);
      break;
    case 3: {
      const Part part = some_part(bytes, 64, random);
      bytes.erase(part.begin, part.size);
      break;
    }
    case 4: {
      const Part part = some_part(bytes, 256, random);
      bytes.insert(random.below(bytes.size()), bytes.substr(part.begin, part.size));
      break;
    }
    case 5: {
      std::string noise(1 + random.below(16), ' ');
      for (char& c : noise) c = static_cast<char>(random.below(256));
      bytes.insert(random.below(bytes.size()), noise);
      break;
    }
    case 6: {
      // Long words, deep nesting, many columns.
      const Part part = some_part(bytes, 12, random);
      const std::string word = bytes.substr(part.begin, part.size);
      std::string many;
      for (std::size_t left = std::size_t{1} << random.below(17U); left > 0; --left) many += word;
      bytes.insert(part.begin, many);
      break;
    }
    case 7: {
      const std::uint32_t number = any_of(k_numbers);
      const auto four = std::bit_cast<std::array<char, sizeof number>>(number);
      bytes.replace(random.below(bytes.size()), four.size(), four.data(), four.size());
      break;
    }
    default: {
      const Part part = some_number(bytes, random);
      bytes.replace(part.begin, part.size, any_of(k_words));
      break;
    }
  }
}

}  // namespace

std::string mutated(std::string bytes, RandomStream& random) {
  for (std::size_t changes = 1 + random.below(3); changes > 0 && !bytes.empty(); --changes) change(bytes, random);
  return bytes;
}

}  // namespace cloud2csg::fuzz
