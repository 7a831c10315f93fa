// load_map() and save_map(): a map file as a whole.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "server/map_store.hpp"
#include "server/store/file_lock.hpp"
#include "server/store/map_meta.hpp"
#include "server/store/map_reader.hpp"
#include "server/store/map_schema.hpp"
#include "server/store/map_tables.hpp"
#include "server/store/store_file.hpp"

namespace flogmap {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& path, const char* suffix) { return path.string() + suffix; }

void sync(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  const bool done = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::string reason = std::strerror(errno);
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw std::runtime_error(path.string() + ": cannot be made durable (" + reason + ")");
}

void write_whole(const fs::path& path, const StoredMap& map) {
  SqliteDatabase database(path, SqliteDatabase::Mode::write);
  database.execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF");  // a failure throws the file away
  create_map_schema(database);
  database.execute("BEGIN");
  MapTables tables(database);
  tables.replace_all(map);
  tables.write_seal();
  database.execute("COMMIT");
}

/// A journal left by a killed writer must not be replayed into the file that comes in place of its own.
/// It first goes where it belongs, so that the old map is whole for as long as it stands.
void settle_journal_of(const fs::path& path) {
  if (!fs::exists(beside(path, "-wal"))) return;
  try {
    SqliteDatabase old(path, SqliteDatabase::Mode::write);
    old.execute("PRAGMA wal_checkpoint(TRUNCATE); PRAGMA journal_mode = DELETE");
  } catch (const SqliteError&) {
    // Too damaged to be settled, and about to be replaced.
  }
  fs::remove(beside(path, "-wal"));
  fs::remove(beside(path, "-shm"));
}

/// A file that is gone with its owner unless it was moved away.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) { remove(); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { remove(); }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  fs::path path_;
};

}  // namespace

StoredMap load_map(const fs::path& path) {
  SqliteDatabase database = open_map_for_reading(path);
  check_map_schema(database);
  if (!has_header(database)) {
    throw std::runtime_error(path.string() + ": holds no map yet; map something into it first");
  }
  return read_map(database);
}

void save_map(const fs::path& path, const StoredMap& map) {
  const FileLock only_writer(path);
  const TemporaryFile fresh(beside(path, (".new-" + std::to_string(::getpid())).c_str()));
  write_whole(fresh.path(), map);
  sync(fresh.path(), O_RDONLY);
  settle_journal_of(path);
  std::error_code error;
  fs::rename(fresh.path(), path, error);
  if (error) throw std::runtime_error(path.string() + ": cannot be replaced (" + error.message() + ")");
  sync(fs::absolute(path).parent_path(), O_RDONLY | O_DIRECTORY);
}

void check_same_grid(const fs::path& path, const GridSpec& stored, const GridSpec& wanted) {
  const auto list = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) {
      std::string digits = std::to_string(number);
      digits.erase(digits.find_last_not_of('0') + 1);
      if (digits.back() == '.') digits.pop_back();
      text += (text.empty() ? "" : ",") + digits;
    }
    return text;
  };
  const auto complain = [&](const std::string& option, const auto& was, const auto& is) {
    throw std::runtime_error(path.string() + ": this map was made with " + option + " " + list(was) +
                             ", now it is " + list(is) + "; start with " + option + " " + list(was) +
                             ", or name another file for a new map");
  };
  using Numbers = std::vector<double>;
  if (stored.cell_size_m != wanted.cell_size_m) {
    complain("--cell-size", Numbers{stored.cell_size_m}, Numbers{wanted.cell_size_m});
  }
  if (stored.layer_bounds_m != wanted.layer_bounds_m) {
    complain("--layers", stored.layer_bounds_m, wanted.layer_bounds_m);
  }
}

MapSnapshot snapshot_of(const StoredMap& map) {
  MapSnapshot snapshot{map.info, map.revision, {}};
  for (const TileUpdate& update : map.tiles) snapshot.tiles[update.index] = update.tile;
  return snapshot;
}

}  // namespace flogmap
