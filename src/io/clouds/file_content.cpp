#include "io/clouds/file_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_bytes_a_read = std::size_t{1} << 26;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

FileContent::FileContent(const std::filesystem::path& file, const RunContext& run, std::size_t limit)
    : name_(file.string()) {
  std::error_code status_error;
  if (std::filesystem::is_directory(file, status_error)) fail("expected a file, found a directory");
  const std::unique_ptr<std::FILE, CloseFile> in(std::fopen(file.c_str(), "rb"));
  if (in == nullptr) {
    fail(fmt::format("cannot be read ({})", std::strerror(errno)), "check the path and its permissions");
  }
  // A pipe has no size, so the buffer grows block by block. For a regular file, one extra byte detects the end.
  const std::uintmax_t announced = std::filesystem::file_size(file, status_error);
  grow(status_error ? k_bytes_a_read : std::min<std::size_t>(announced, limit - 1) + 1);
  while (size_ < limit) {
    run.throw_if_stopped();
    if (size_ == capacity_) grow(2 * capacity_);
    const std::size_t wanted = std::min({k_bytes_a_read, capacity_ - size_, limit - size_});
    const std::size_t got = std::fread(bytes_.get() + size_, 1, wanted, in.get());
    size_ += got;
    if (got < wanted) break;
  }
  if (std::ferror(in.get()) != 0) fail(fmt::format("cannot be read ({})", std::strerror(errno)));
}

void FileContent::grow(std::size_t capacity) {
  auto larger = std::make_unique_for_overwrite<char[]>(capacity);  // NOLINT(modernize-avoid-c-arrays)
  if (size_ > 0) std::memcpy(larger.get(), bytes_.get(), size_);
  bytes_ = std::move(larger);
  capacity_ = capacity;
}

void FileContent::fail(FilePosition where, std::string expected, std::string remedy) const {
  constexpr std::array<const char*, 4> k_units{"line", "byte", "vertex", "triangle"};
  throw Error({.file = name_,
               .where = fmt::format("{} {}", k_units.at(static_cast<std::size_t>(where.unit)), where.number),
               .expected = std::move(expected),
               .remedy = std::move(remedy)});
}

void FileContent::fail(std::string expected, std::string remedy) const {
  throw Error({.file = name_, .expected = std::move(expected), .remedy = std::move(remedy)});
}

void FileContent::fail_truncated(FilePosition where, std::size_t announced, std::size_t found,
                                 const char* things) const {
  fail(where, fmt::format("the file announces {} {} but ends after {}", announced, things, found), k_copy_again);
}

}  // namespace cloud2csg
