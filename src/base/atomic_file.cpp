#include "base/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

AtomicFile::AtomicFile(std::filesystem::path target)
    : target_(std::move(target)), temporary_(fmt::format("{}.{}.part", target_.string(), ::getpid())) {
  file_ = std::fopen(temporary_.c_str(), "wb");
  if (file_ == nullptr) fail("cannot be opened for writing");
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
}

void AtomicFile::commit() {
  const int flushed = std::fflush(file_);
  const int synced = flushed == 0 ? ::fsync(::fileno(file_)) : flushed;
  // Pipes and some network file systems cannot be synced; that is no loss of data.
  if (flushed != 0 || (synced != 0 && errno != EINVAL && errno != EROFS)) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot be written");
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be put in place");
}

void AtomicFile::fail(const char* what) const {
  throw Error({.file = target_.string(),
               .where = {},
               .expected = fmt::format("{} ({})", what, std::strerror(errno)),
               .remedy = "check the folder, its permissions and the free space"});
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

std::string read_text_file(const std::filesystem::path& file) {
  const auto fail = [&file] {
    throw Error({.file = file.string(),
                 .where = {},
                 .expected = fmt::format("cannot be read ({})", std::strerror(errno)),
                 .remedy = "check the path and its permissions"});
  };
  std::FILE* in = std::fopen(file.c_str(), "rb");
  if (in == nullptr) fail();
  std::string text;
  char buffer[1 << 16];
  std::size_t got = 0;
  while ((got = std::fread(buffer, 1, sizeof buffer, in)) > 0) text.append(buffer, got);
  const bool failed = std::ferror(in) != 0;
  std::fclose(in);
  if (failed) fail();
  return text;
}

}  // namespace cloud2csg
