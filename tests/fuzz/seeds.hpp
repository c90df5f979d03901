#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace cloud2csg::fuzz {

/// A good file, to be made a bad one.
struct Seed {
  std::string ending;
  std::string bytes;
  /// Makes the file of the bytes after they were changed, where a checksum or a length around them would tell of nearly
  /// each change.
  std::string (*pack)(const std::string& bytes) = nullptr;
};

/// One of each format that is read, as the program writes them; those that it does not write, written here.
/// Files for a moment go to `folder`. The same at each call.
[[nodiscard]] std::vector<Seed> make_seeds(const std::filesystem::path& folder);

}  // namespace cloud2csg::fuzz
