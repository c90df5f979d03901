#include "core/base/output_set.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <iterator>
#include <system_error>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/temporary_file.hpp"

namespace cloud2csg {
namespace {

/// Puts each of two files in the place of the other, in one step. False when one is missing or the file system cannot.
bool exchange(const std::filesystem::path& a, const std::filesystem::path& b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

}  // namespace

struct OutputSet::Entry {
  Entry(std::filesystem::path given, std::filesystem::path resolved)
      : target(std::move(given)), place(std::move(resolved)), staged(place, target.extension().string()) {}

  /// An older file is exchanged with the new one, so that it can come back.
  void put_in_place() {
    is_exchanged = exchange(staged.path(), place);
    if (!is_exchanged && std::rename(staged.path().c_str(), place.c_str()) != 0) {
      refuse_output(target, "cannot be put in place", errno);
    }
  }

  void take_back() const {
    if (is_exchanged) {
      exchange(staged.path(), place);
    } else {
      std::rename(place.c_str(), staged.path().c_str());
    }
  }

  std::filesystem::path target;  ///< as the caller names it
  std::filesystem::path place;   ///< the same with links followed
  TemporaryFile staged;
  bool is_exchanged = false;
};

OutputSet::OutputSet() = default;
OutputSet::~OutputSet() = default;

void OutputSet::add(const std::filesystem::path& target,
                    const std::function<void(const std::filesystem::path&)>& write) {
  const Destination destination = destination_of(target);
  if (destination.is_direct) {
    write(target);
    return;
  }
  try {
    entries_.push_back(std::make_unique<Entry>(target, destination.path));
  } catch (const std::system_error& error) {
    refuse_output(target, "cannot be opened for writing", error.code().value());
  }
  const std::filesystem::path& staged = entries_.back()->staged.path();
  try {
    write(staged);
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    if (parts.file == staged.string()) parts.file = target.string();
    throw Error(std::move(parts));
  }
}

void OutputSet::commit() {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    try {
      (*entry)->put_in_place();
    } catch (const Error&) {
      for (auto placed = std::make_reverse_iterator(entry); placed != entries_.rend(); ++placed) (*placed)->take_back();
      throw;
    }
  }
  entries_.clear();
}

}  // namespace cloud2csg
