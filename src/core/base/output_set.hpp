#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace cloud2csg {

/// Several files that appear together under their names: all or none. Each is written beside its place; commit()
/// renames them all. Without it nothing appears, and older files of these names stay. What is no regular file (a pipe,
/// /dev/stdout) is written directly. All functions throw Error naming the file.
class OutputSet {
 public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Calls write(path), which is to write a whole file: not `target` itself, but with the same ending. An Error of it
  /// that names this path is passed on with the name of the target.
  void add(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

  /// When one file cannot be put in place, those before it are taken back.
  void commit();

 private:
  struct Entry;
  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace cloud2csg
