#pragma once

#include <filesystem>

namespace flogmap {

/// A file that says "one program writes here". It vanishes with its owner, and the lock even if the owner is
/// killed and the file stays. A file of its own, because closing any handle of a database drops SQLite's
/// locks.
class FileLock {
 public:
  /// Locks `path` + ".lock". Throws std::runtime_error naming the process that holds it, SqliteError if the
  /// folder takes no file.
  explicit FileLock(const std::filesystem::path& path);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();

 private:
  std::filesystem::path lock_path_;
  int descriptor_ = -1;
};

}  // namespace flogmap
