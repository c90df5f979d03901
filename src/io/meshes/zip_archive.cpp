#include "io/meshes/zip_archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <memory>

#include "cloud2csg/error.hpp"
#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

struct CloseZip {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
template <typename Handle>
using ZipHandle = std::unique_ptr<Handle, CloseZip>;

/// Opens an archive that shares ownership of the bytes. Empty if the bytes are no archive.
ZipHandle<zip_t> open_zip(const ZipHandle<zip_source_t>& bytes, int flags) {
  ZipHandle<zip_t> archive(bytes ? zip_open_from_source(bytes.get(), flags, nullptr) : nullptr);
  if (archive) zip_source_keep(bytes.get());
  return archive;
}

bool add_entry(zip_t* archive, const ZipEntry& entry) {
  constexpr zip_uint32_t k_level = 6;  // zlib's default
  constexpr zip_uint16_t k_first_of_january_1980 = 0x21;
  ZipHandle<zip_source_t> bytes(zip_source_buffer(archive, entry.bytes.data(), entry.bytes.size(), 0));
  const zip_int64_t index = bytes ? zip_file_add(archive, entry.name, bytes.get(), ZIP_FL_ENC_UTF_8) : -1;
  if (index < 0) return false;
  (void)bytes.release();  // the archive owns it now
  const auto added = static_cast<zip_uint64_t>(index);
  return zip_set_file_compression(archive, added, ZIP_CM_DEFLATE, k_level) == 0 &&
         zip_file_set_dostime(archive, added, 0, k_first_of_january_1980, 0) == 0;
}

}  // namespace

std::string zip_archive(std::span<const ZipEntry> entries) {
  const ZipHandle<zip_source_t> bytes(zip_source_buffer_create(nullptr, 0, 0, nullptr));
  ZipHandle<zip_t> archive = open_zip(bytes, ZIP_TRUNCATE);
  const bool is_made =
      archive && std::ranges::all_of(entries, [&](const ZipEntry& entry) { return add_entry(archive.get(), entry); }) &&
      zip_close(archive.get()) == 0;
  if (is_made) (void)archive.release();
  zip_stat_t status{};
  if (is_made && zip_source_stat(bytes.get(), &status) == 0 && zip_source_open(bytes.get()) == 0) {
    std::string all(status.size, '\0');
    const zip_int64_t got = zip_source_read(bytes.get(), all.data(), all.size());
    zip_source_close(bytes.get());
    if (got == static_cast<zip_int64_t>(all.size())) return all;
  }
  throw Error({.expected = "an archive cannot be created in memory"});
}

std::string unzip_entry(const FileContent& file, const std::string& name, std::size_t limit) {
  const ZipHandle<zip_source_t> bytes(zip_source_buffer_create(file.bytes().data(), file.bytes().size(), 0, nullptr));
  const ZipHandle<zip_t> archive = open_zip(bytes, ZIP_RDONLY);
  if (!archive) file.fail("expected a zip archive, found none, or a damaged one", k_copy_again);
  const ZipHandle<zip_file_t> entry(zip_fopen(archive.get(), name.c_str(), 0));
  const std::string shown = visible_text(name, k_longest_quote);
  if (!entry) file.fail(fmt::format("expected {} in the archive ({})", shown, zip_strerror(archive.get())));
  std::string all;
  std::array<char, std::size_t{1} << 16U> block{};
  zip_int64_t got = 0;
  while ((got = zip_fread(entry.get(), block.data(), block.size())) > 0) {
    all.append(block.data(), static_cast<std::size_t>(got));
    if (all.size() > limit) file.fail(fmt::format("{} is too large when unpacked: over {} bytes", shown, limit));
  }
  if (got < 0)
    file.fail(fmt::format("{} cannot be unpacked ({})", shown, zip_file_strerror(entry.get())), k_copy_again);
  return all;
}

}  // namespace cloud2csg
