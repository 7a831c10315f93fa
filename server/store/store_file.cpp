#include "server/store/store_file.hpp"

#include <string>
#include <utility>

#include "server/store/map_schema.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

void check_is_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw std::runtime_error(path.string() + ": no such file; name a map.flog");
  if (!fs::is_regular_file(status)) throw std::runtime_error(path.string() + ": not a file; name a map.flog");
}

// WAL: readers and the writer do not wait for one another. FULL: a commit outlives a power cut; one sync a
// second is cheap. The limit gives the space of a burst back.
constexpr const char* kLiveMode =
    "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA journal_size_limit = 16777216";

SqliteDatabase open_for_writing(const fs::path& path) {
  SqliteDatabase database(path, SqliteDatabase::Mode::write);
  if (is_blank(database)) create_map_schema(database);
  check_map_schema(database);
  database.execute(kLiveMode);
  return database;
}

/// A map that has been read already: a disk that still refuses is to say so before the long check.
SqliteDatabase reopen_for_writing(const fs::path& path) {
  SqliteDatabase database(path, SqliteDatabase::Mode::write);
  database.execute(kLiveMode);
  check_map_schema(database);
  return database;
}

/// The disk may take more tomorrow; a file that is damaged or in use stays so.
bool may_pass(SqliteFault fault) {
  return fault == SqliteFault::disk_full || fault == SqliteFault::read_only ||
         fault == SqliteFault::disk_error || fault == SqliteFault::cannot_open;
}

/// The map that is there, of a file that cannot be written.
std::optional<SqliteDatabase> readable_map(const fs::path& path) {
  std::error_code error;
  if (fs::file_size(path, error) == 0 || error) return std::nullopt;
  SqliteDatabase database = open_map_for_reading(path);
  check_map_schema(database);
  return database;
}

}  // namespace

SqliteDatabase open_map_for_reading(const fs::path& path) {
  check_is_file(path);
  try {
    SqliteDatabase database(path, SqliteDatabase::Mode::read);
    is_blank(database);
    return database;
  } catch (const SqliteError& error) {
    // Where nothing may be written SQLite cannot even lock, but a file without a journal needs no lock there.
    const bool unwritable =
        error.fault() == SqliteFault::cannot_open || error.fault() == SqliteFault::read_only;
    if (!unwritable || fs::exists(path.string() + "-wal")) throw;
  }
  return {path, SqliteDatabase::Mode::immutable};
}

StoreFile::StoreFile(fs::path path) : path_(std::move(path)) {
  try {
    make_writable();
  } catch (const SqliteError& error) {
    if (!may_pass(error.fault())) throw;
    database_ = readable_map(path_);
    if (!database_) throw;
  }
}

void StoreFile::make_writable() {
  if (writable()) return;
  FileLock lock(path_);
  database_ = database_ ? reopen_for_writing(path_) : open_for_writing(path_);
  lock_ = std::move(lock);
}

}  // namespace flogmap
