#include "base/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)), destination_(target_) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(target_, ignored);
  if (std::filesystem::is_directory(status)) {
    errno = EISDIR;
    fail("cannot be written");
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    file_ = std::fopen(target_.c_str(), "wb");
  } else {
    open_temporary();
  }
  if (file_ == nullptr) fail("cannot be opened for writing");
}

void AtomicFile::open_temporary() {
  // A rename would put the file in the place of a link, not of what the link points to.
  std::error_code unresolved;
  const std::filesystem::path resolved = std::filesystem::canonical(target_, unresolved);
  if (!unresolved) destination_ = resolved;
  constexpr int k_most_trials = 100;
  for (int trial = 0; trial < k_most_trials && file_ == nullptr; ++trial) {
    temporary_ = fmt::format("{}.{}.{}.part", destination_.string(), ::getpid(), trial);
    file_ = std::fopen(temporary_.c_str(), "wbx");
    if (file_ == nullptr && errno != EEXIST) break;
  }
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
}

void AtomicFile::commit() {
  const int flushed = std::fflush(file_);
  const int synced = flushed == 0 ? ::fsync(::fileno(file_)) : flushed;
  // Pipes, terminals and some network file systems cannot be synced; that is no loss of data.
  if (flushed != 0 || (synced != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP)) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot be written");
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), destination_.c_str()) != 0) fail("cannot be put in place");
  temporary_.clear();
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
  const auto fail = [&file](int reason) {
    throw Error({.file = file.string(),
                 .where = {},
                 .expected = fmt::format("cannot be read ({})", std::strerror(reason)),
                 .remedy = "check the path and its permissions"});
  };
  std::FILE* in = std::fopen(file.c_str(), "rb");
  if (in == nullptr) fail(errno);
  std::string text;
  std::vector<char> buffer(std::size_t{1} << 16);
  std::size_t got = 0;
  while ((got = std::fread(buffer.data(), 1, buffer.size(), in)) > 0) text.append(buffer.data(), got);
  const int reason = std::ferror(in) != 0 ? errno : 0;
  std::fclose(in);
  if (reason != 0) fail(reason);
  return text;
}

}  // namespace cloud2csg
