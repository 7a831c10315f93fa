// The file of a live store: who may write to it, and whether the disk lets anybody.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>

#include "server/store/file_lock.hpp"
#include "server/store/sqlite.hpp"

namespace flogmap {

/// A connection that never writes, even where nothing can be written, not even a lock. Throws
/// std::runtime_error if there is no such file.
SqliteDatabase open_map_for_reading(const std::filesystem::path& path);

/// The lock and the connection of the one program that writes to a store. A disk that takes nothing now, full
/// or read-only, keeps nobody from reading the map that is there: then the file is open for reading alone
/// until make_writable() succeeds.
class StoreFile {
 public:
  /// Creates the file if there is none. Throws std::runtime_error naming the file if it is no map, damaged,
  /// in use, or neither there nor to be created.
  explicit StoreFile(std::filesystem::path path);

  [[nodiscard]] bool writable() const { return lock_.has_value(); }
  /// Tries again; throws std::runtime_error naming the file while the disk refuses.
  void make_writable();

  [[nodiscard]] SqliteDatabase& database() { return *database_; }
  [[nodiscard]] const SqliteDatabase& database() const { return *database_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::optional<FileLock> lock_;  // taken before the database is opened, given back after it is closed
  std::optional<SqliteDatabase> database_;
};

}  // namespace flogmap
