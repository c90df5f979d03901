#include "core/base/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  const Destination destination = destination_of(target_);
  place_ = destination.path;
  try {
    if (!destination.is_direct) temporary_.emplace(place_);
  } catch (const std::system_error& error) {
    refuse_output(target_, "cannot be opened for writing", error.code().value());
  }
  file_ = std::fopen(temporary_ ? temporary_->path().c_str() : target_.c_str(), "wb");
  if (file_ == nullptr) fail("cannot be opened for writing");
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
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
  if (!temporary_) return;
  if (std::rename(temporary_->path().c_str(), place_.c_str()) != 0) fail("cannot be put in place");
  temporary_.reset();
}

void AtomicFile::fail(const char* what) const {
  refuse_output(target_, what, errno);
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

std::string read_text_file(const std::filesystem::path& file) {
  const auto fail = [&file](int reason) {
    throw Error({.file = file.string(),
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
